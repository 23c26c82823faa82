#include "app/serve/queue/queue_page.hpp"

#include "app/http/static_folder.hpp"
#include "app/jobs/status_output.hpp"
#include "app/site/site_page.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

namespace macadam {
namespace {

constexpr std::string_view page_path = "/queue";
constexpr std::string_view status_path = "/queue/status";

HttpResponse status_response(const QueueReading& reading) {
    if (!reading.status) {
        auto response = http_problem(503, reading.problem);
        response.headers.emplace_back("Retry-After", "5");
        return response;
    }
    JsonObject object;
    object.add("read", utc_text(reading.read_ms))
        .add("queue", JsonRaw{status_json(*reading.status)});
    return {.body = object.text() + "\n", .cache_control = "no-store"};
}

/// Returns a file of the page, which this build may lack.
HttpResponse page_response(std::string_view path) {
    try {
        if (auto file = file_response(site_page_folder(), path)) {
            file->cache_control = "private, no-cache";
            return *std::move(file);
        }
    } catch (const InputError&) {
        return http_problem(404,
                            "this build of the program has no web page; /queue/status has the "
                            "same as JSON");
    }
    return http_problem(404, "there is no such page");
}

} // namespace

bool is_path_of_queue(std::string_view path) {
    return path.starts_with(page_path) &&
           (path.size() == page_path.size() || path[page_path.size()] == '/');
}

HttpResponse queue_response(const HttpRequest& request, QueueWatch* queue) {
    HttpResponse response =
        queue == nullptr
            ? http_problem(404, "a database in a file has no queue; /v1/trips lists its uploads")
        : request.path == status_path ? status_response(*queue->latest())
                                      : page_response(request.path);
    response.route = request.path == status_path ? status_path : page_path;
    return response;
}

} // namespace macadam
