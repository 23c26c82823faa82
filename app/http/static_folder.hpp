#pragma once

#include "app/http/http_message.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace macadam {

/// Returns a file of a folder for the path of a request; index.html for a path that ends in a
/// slash; a redirection to the slash for a folder. `std::nullopt` if there is none. Paths with
/// "..", names that begin with a dot, symbolic links and what is no ordinary file are not found.
std::optional<HttpResponse> file_response(const std::filesystem::path& folder,
                                          std::string_view path);

/// Media type by the suffix of a name; "application/octet-stream" for others.
std::string_view media_type_of(const std::filesystem::path& file);

} // namespace macadam
