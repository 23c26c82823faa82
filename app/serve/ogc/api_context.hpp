#pragma once

#include "app/http/http_message.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Request, database and addresses from which a page of the API is made.
struct ApiContext {
    const HttpRequest& request;
    const StoreReader& store;
    const std::string& version;  ///< of the database
    std::string base;            ///< address of the server, without a slash at its end
    bool is_operator = false;    ///< a token says so
    std::string trips_version{}; ///< of the trips, published or not; for operators
};

/// Link of a page (RFC 8288).
struct ApiLink {
    std::string href; ///< whole
    std::string_view rel;
    std::string_view type;
    std::string title{};
};

/// Formats links as a JSON array.
std::string links_text(const std::vector<ApiLink>& links);

/// Returns a JSON page with an ETag of the version and of the request; as HTML for a browser, which
/// asks for it by its header Accept or by f=html.
HttpResponse api_page(const ApiContext& context,
                      std::string title,
                      std::string json,
                      std::string_view type = "application/json");

/// Refuses parameters that are given more than once: clients and proxies differ in which they mean.
/// \throws UsageError  for the first of them.
void expect_single(const HttpRequest& request);

/// Refuses those, and parameters other than those named, and f.
/// \throws UsageError  for the first other one.
void expect_parameters(const HttpRequest& request, const std::vector<std::string_view>& known = {});

} // namespace macadam
