#pragma once

#include "storage/store/copy/region_cut.hpp"
#include "support/roads/road_art.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Roads to be cut: way 1 (ABC) is cut at B, where way 2 (BE) meets it: 3 and 8 segments, where 10
/// would be without. Way 3 (ED) meets way 2.
RoadArt cut_roads();

/// Box of a metre around a place.
GeoBox box_around(const GeoPoint& at);

/// Region "the box".
Region region_of(const GeoBox& box);

/// Cuts a region out of a file, or of a database on a server.
StoreCopy
cut_from(const std::string& database, const Region& region, const std::filesystem::path& file);

/// Rows of all tables that only one of two files has, but those of the audit, which names the
/// source.
std::vector<std::string> different_rows(const std::filesystem::path& a,
                                        const std::filesystem::path& b);

} // namespace macadam::testing
