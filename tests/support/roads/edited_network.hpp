#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace macadam::testing {

/// Which step of which old way a step of a new one is.
struct StepOrigin {
    std::int64_t way_id;
    std::size_t step; ///< between its points `step` and `step` + 1
    bool reversed;
};

struct EditedWay {
    Way way;
    std::vector<std::optional<StepOrigin>> steps; ///< nothing: it is no old road
};

/// A map and what mappers make of it. Each edit knows what has become of every step of every way.
struct EditedNetwork {
    std::vector<EditedWay> ways;
};

EditedNetwork edited(const std::vector<Way>& ways);
std::vector<Way> ways_of(const EditedNetwork& network);

/// In two at a point within its line; the second part gets another id.
void split(EditedNetwork& network, std::int64_t way_id, std::size_t point, std::int64_t second_id);

/// `second` goes on where `first` ends; it goes.
void merge(EditedNetwork& network, std::int64_t first_id, std::int64_t second_id);

void renumber(EditedNetwork& network, std::int64_t way_id, std::int64_t new_id);
void reverse(EditedNetwork& network, std::int64_t way_id);
void erase(EditedNetwork& network, std::int64_t way_id);

/// Every point elsewhere, by the identity of its node.
void nudge(EditedNetwork& network,
           const std::function<GeoPoint(std::int64_t node_id, const GeoPoint&)>& moved);

/// The way built anew `aside_m` to its right, joined to nothing: not the same road any more.
void rebuild_aside(EditedNetwork& network,
                   std::int64_t way_id,
                   double aside_m,
                   std::int64_t first_node_id);

/// A new road along it, `aside_m` to its right, joined to nothing.
void add_parallel(EditedNetwork& network,
                  std::int64_t way_id,
                  double aside_m,
                  std::int64_t new_id,
                  std::int64_t first_node_id);

/// Metres of directed road.
struct ChangeScore {
    double right_m = 0; ///< found where they are, or told to be gone
    double wrong_m = 0; ///< found elsewhere
    double lost_m = 0;  ///< not found, but they are there
};

/// \param most_off_m  along the road
ChangeScore
score(const std::vector<Way>& before, const EditedNetwork& after, double most_off_m = 5);

} // namespace macadam::testing
