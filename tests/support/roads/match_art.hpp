#pragma once

#include "mapping/matching/map_match.hpp"
#include "road_art.hpp"

#include <string>

namespace macadam::testing {

/// The trip on the roads of a drawing.
MatchedTrace match(const TripLog& trip, const RoadArt& art, const MatchConfig& config = {});

/// The letters of the ways' points as driven: "ABE". A hole is a '-'.
std::string letters_of(const MatchedTrace& trace, const RoadArt& art);

/// Where on its edge the trip was at a travel, or NaN.
GeoPoint place_at(const MatchedTrace& trace, const RoadArt& art, double travel_m);

/// Two roads beside each other, ABC and DEF, and a third across from B to E.
RoadArt ladder();

} // namespace macadam::testing
