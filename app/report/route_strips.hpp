#pragma once

#include "mapping/routes/shortest_path.hpp"
#include "render/report/report.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {

/// Road of a strip chart: a way, or the best route between two positions.
struct StripRoad {
    std::optional<std::int64_t> way_id{};
    std::optional<std::pair<GeoPoint, GeoPoint>> route{};
    RouteConfig::Best best = RouteConfig::Best::quickest;
};

/// Reads the roughness along a road by chainage, in its direction and against it, with the names of
/// the roads that join it and the control and reference sections on it. Long roads become several
/// strips one after the other.
///
/// \param filter       only its period, passes and cars count
/// \throws InputError  if the network has no such way, or no route joins the positions.
std::vector<Strip> route_strips(const StoreReader& store,
                                const RoadNetwork& roads,
                                const StripRoad& road,
                                const SegmentFilter& filter,
                                const ClassTable& classes,
                                const Localisation& wording);

} // namespace macadam
