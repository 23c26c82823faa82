#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace macadam::testing {

/// Step of an old way that a step of a new way comes from.
struct StepOrigin {
    std::int64_t way_id;
    std::size_t step; ///< between points `step` and `step` + 1
    bool reversed;
};

struct EditedWay {
    Way way;
    std::vector<std::optional<StepOrigin>> steps; ///< `std::nullopt`: no old road
};

/// Map with edits. Each edit records the origin of every step of every way.
struct EditedNetwork {
    std::vector<EditedWay> ways;
};

EditedNetwork edited(const std::vector<Way>& ways);
std::vector<Way> ways_of(const EditedNetwork& network);

/// Splits a way at a point within its line; the second part gets another id.
void split(EditedNetwork& network, std::int64_t way_id, std::size_t point, std::int64_t second_id);

/// Appends `second` to the end of `first` and removes it.
void merge(EditedNetwork& network, std::int64_t first_id, std::int64_t second_id);

void renumber(EditedNetwork& network, std::int64_t way_id, std::int64_t new_id);
void reverse(EditedNetwork& network, std::int64_t way_id);
void erase(EditedNetwork& network, std::int64_t way_id);

/// Moves every point, by the id of its node.
void nudge(EditedNetwork& network,
           const std::function<GeoPoint(std::int64_t node_id, const GeoPoint&)>& moved);

/// Rebuilds the way `aside_m` to its right without connections, so that it is another road.
void rebuild_aside(EditedNetwork& network,
                   std::int64_t way_id,
                   double aside_m,
                   std::int64_t first_node_id);

/// Adds a new road `aside_m` to the right of the way, without connections.
void add_parallel(EditedNetwork& network,
                  std::int64_t way_id,
                  double aside_m,
                  std::int64_t new_id,
                  std::int64_t first_node_id);

/// Score of a network update, in metres of directed road.
struct ChangeScore {
    double right_m = 0; ///< found at the right position, or correctly reported as gone
    double wrong_m = 0; ///< found at a wrong position
    double lost_m = 0;  ///< not found, although it exists
};

/// Scores an update of the old ways against the edited network.
/// \param most_off_m  tolerance along the road
ChangeScore
score(const std::vector<Way>& before, const EditedNetwork& after, double most_off_m = 5);

} // namespace macadam::testing
