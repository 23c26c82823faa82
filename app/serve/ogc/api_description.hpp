#pragma once

#include "app/serve/ogc/api_context.hpp"

namespace macadam {

/// Landing page of the API: its links.
HttpResponse landing_page(const ApiContext& context);

/// Conformance classes that are implemented.
HttpResponse conformance_page(const ApiContext& context);

/// Definition of the API, OpenAPI 3.0.
HttpResponse openapi_page(const ApiContext& context);

} // namespace macadam
