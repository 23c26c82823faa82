#pragma once

#include "app/http/http_message.hpp"
#include "app/serve/features/coordinate_reference.hpp"
#include "app/serve/features/feature.hpp"
#include "storage/store/records/segment_filter.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

inline constexpr std::size_t default_limit = 100; ///< features of a page
inline constexpr std::size_t max_limit = 10'000;  ///< more are not refused, but not given, either

/// Request for the features of a collection.
struct ItemsQuery {
    std::optional<GeoBox> box;
    std::optional<Period> period;
    std::vector<FeatureTest> tests; ///< all must hold
    std::string selection;          ///< text of all of the above: equal for equal selections
    std::size_t limit = default_limit;
    std::size_t offset = 0;
    std::optional<std::string> after{}; ///< id of the last feature of the page before
    CoordinateReference crs = CoordinateReference::crs84;
    std::string rest; ///< parameters as a query without limit, offset and after: "&bbox=..."
};

/// Parses parameters of .../items (OGC API - Features 1 and 2).
///
/// \param columns  their names are parameters, too
/// \throws UsageError  for an unknown parameter and for a bad value; the words are for the client.
ItemsQuery parse_items_query(const HttpRequest& request, std::span<const FeatureColumn> columns);

/// Parses the parameter crs, alone.
/// \throws UsageError  for an unknown one.
CoordinateReference parse_crs(const HttpRequest& request);

/// Parses a moment or an interval of RFC 3339: "2026-05-01", "2026-05-01T00:00:00Z/..".
/// \throws UsageError  for other text, and for an end before the beginning.
Period parse_datetime(const std::string& text);

} // namespace macadam
