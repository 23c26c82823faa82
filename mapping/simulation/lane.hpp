#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/fleet_scenario.hpp"
#include "mapping/surveys/segment_truth.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace macadam {

/// A way in one direction: what has one surface. Stations count from where the lane begins.
struct Lane {
    std::uint32_t way; ///< in RoadNetwork::ways
    bool forward;
    friend auto operator<=>(const Lane&, const Lane&) = default;
};

/// Where lanes are got from: made when asked for, or kept.
using LaneSource = std::function<std::shared_ptr<const RoadSurface>(const Lane&)>;

/// Lanes that may be driven, in the order of the keys of their segments.
std::vector<Lane> drivable_lanes(const RoadNetwork& roads);

/// A whole number of millimetres, so that the last bits of a length decide nothing.
double whole_mm(double length_m);

double lane_length_m(const RoadNetwork& roads, const Lane& lane);

/// What the rules say of a lane, in their order.
RoadRecipe
road_recipe(const FleetScenario& recipe, const WayView& way, bool forward, std::uint64_t seed);

/// The lane's road: fixed by way, direction and seed, so that all cars feel the same.
RoadSurface lane_surface(const FleetScenario& recipe,
                         const RoadNetwork& roads,
                         const Lane& lane,
                         std::uint64_t seed);

/// The golden car (estimator/iri/iri.hpp) on both wheel paths of the whole lane without a restart;
/// a segment is the mean over its cells. In the order of the keys.
std::vector<SegmentTruth>
lane_truth(const RoadNetwork& roads, const Lane& lane, const RoadSurface& surface);

} // namespace macadam
