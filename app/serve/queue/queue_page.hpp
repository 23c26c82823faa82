#pragma once

#include "app/http/http_message.hpp"
#include "app/serve/queue/queue_watch.hpp"

#include <string_view>

namespace macadam {

/// Tests for a path of the page that shows operators the queue: "/queue", "/queue/status".
bool is_path_of_queue(std::string_view path);

/// Answers a request of an operator: the files of the page, or the state of the queue as JSON.
/// \param queue  null: the database is a file, which has none
HttpResponse queue_response(const HttpRequest& request, QueueWatch* queue);

} // namespace macadam
