#pragma once

#include "mapping/background/background.hpp"
#include "storage/networks/osm_tags.hpp"

#include <cstdint>
#include <optional>

namespace macadam {

/// Returns the kind of area of a closed way or multipolygon; `std::nullopt` if it is not shown.
/// Buildings under the ground are not.
std::optional<BackgroundKind> area_kind_of(const OsmTags& tags);

/// Returns the kind of line of a way; `std::nullopt` if it is not shown, as in tunnels. Trams and
/// underground railways are not.
std::optional<BackgroundKind> line_kind_of(const OsmTags& tags);

/// Tests for ways between land, on their left, and sea.
bool is_coastline(const OsmTags& tags);

/// Tests for relations whose ways are the rings of an area.
bool is_multipolygon(const OsmTags& tags);

/// Returns the rank of a node with a place's name; `std::nullopt` if it is none that is shown.
std::optional<PlaceRank> place_rank_of(const OsmTags& tags);

/// Returns the value of `population`; 0 if it is missing or no whole number.
std::int64_t population_of(const OsmTags& tags);

} // namespace macadam
