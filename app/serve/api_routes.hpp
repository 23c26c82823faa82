#pragma once

#include "app/http/http_message.hpp"
#include "app/serve/live/live_content.hpp"
#include "app/serve/live/picture_tiles.hpp"
#include "app/serve/ogc/api_context.hpp"
#include "app/serve/ogc/features_api.hpp"

#include <string_view>

namespace macadam {

/// Sources of the answers of a server: the database and what is made from it.
struct Pages {
    FeaturesApi features;
    const LiveContent& live;
    PictureTiles& pictures;
    bool has_queue = false; ///< of the database, on a server
};

/// Tests for a path of the recorder, also without the slash to which it is redirected.
bool is_path_of_recorder(std::string_view path);

/// Answers a request to read from the API, or else from the files of the web page.
/// \throws InputError  if the database cannot be read.
HttpResponse answer_reading(Pages& pages, const ApiContext& context);

} // namespace macadam
