#pragma once

#include "app/serve/ogc/api_context.hpp"
#include "app/serve/ogc/collections.hpp"

#include <vector>

namespace macadam {

/// Landing page of the API: its links.
HttpResponse landing_page(const ApiContext& context);

/// Conformance classes that are implemented.
HttpResponse conformance_page(const ApiContext& context);

/// Definition of the API, OpenAPI 3.0.
/// \param collections  that everybody sees
/// \param has_queue    the database has one
HttpResponse openapi_page(const ApiContext& context,
                          const std::vector<const Collection*>& collections,
                          bool has_queue);

} // namespace macadam
