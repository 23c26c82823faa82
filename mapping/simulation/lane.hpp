#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/fleet_scenario.hpp"
#include "mapping/surveys/segment_truth.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace macadam {

/// A way in one direction, with one surface. Stations count from the start of the lane.
struct Lane {
    std::uint32_t way; ///< index into RoadNetwork::ways
    bool forward;
    friend auto operator<=>(const Lane&, const Lane&) = default;
};

/// Source of lane surfaces: computed on demand, or cached.
using LaneSource = std::function<std::shared_ptr<const RoadSurface>(const Lane&)>;

/// Returns the drivable lanes, in the key order of their segments.
std::vector<Lane> drivable_lanes(const RoadNetwork& roads);

/// Rounds to whole millimetres, so that the last bits of a length have no effect.
double whole_mm(double length_m);

double lane_length_m(const RoadNetwork& roads, const Lane& lane);

/// Applies the rules to a lane, in their order.
RoadRecipe
road_recipe(const FleetScenario& recipe, const WayView& way, bool forward, std::uint64_t seed);

/// Generates the lane's surface, determined by way, direction and seed, so that it is the same for
/// all cars.
RoadSurface lane_surface(const FleetScenario& recipe,
                         const RoadNetwork& roads,
                         const Lane& lane,
                         std::uint64_t seed);

/// Runs the quarter-car simulation of the IRI (estimator/iri/iri.hpp) on both wheel paths of the
/// entire lane without a restart; the value of a segment is the mean over its cells. In key order.
std::vector<SegmentTruth>
lane_truth(const RoadNetwork& roads, const Lane& lane, const RoadSurface& surface);

/// Returns the potholes of a lane's surface, in order along the lane.
std::vector<PotholeTruth> lane_potholes(const FleetScenario& recipe,
                                        const RoadNetwork& roads,
                                        const Lane& lane,
                                        const RoadSurface& surface,
                                        std::uint64_t seed);

} // namespace macadam
