#pragma once

#include "mapping/matching/map_match.hpp"
#include "road_art.hpp"

#include <string>

namespace macadam::testing {

/// Matches the trip to the roads of a drawing.
MatchedTrace match(const TripLog& trip, const RoadArt& art, const MatchConfig& config = {});

/// Returns the letters of the ways' points as driven: "ABE". A gap is a '-'.
std::string letters_of(const MatchedTrace& trace, const RoadArt& art);

/// Returns the matched position at a travel, on its edge; NaN if there is none.
GeoPoint place_at(const MatchedTrace& trace, const RoadArt& art, double travel_m);

/// Builds two parallel roads, ABC and DEF, and a third from B to E.
RoadArt ladder();

} // namespace macadam::testing
