#include "support/roads/region_cuts.hpp"

#include "storage/postgres/server_address.hpp"
#include "storage/store/server/cut/server_cut.hpp"
#include "support/roads/engine_world.hpp"

#include <algorithm>
#include <iterator>

namespace macadam::testing {

RoadArt cut_roads() {
    return road_art(R"(
        A----B-------------C
             |
        D----E
    )",
                    11,
                    {"ABC", "BE", "ED"});
}

GeoBox box_around(const GeoPoint& at) {
    constexpr double deg = 1e-5;
    return {at.lon_deg - deg, at.lat_deg - deg, at.lon_deg + deg, at.lat_deg + deg};
}

Region region_of(const GeoBox& box) {
    Region region{.place = {}, .words = "the box"};
    region.place.box = box;
    return region;
}

StoreCopy
cut_from(const std::string& database, const Region& region, const std::filesystem::path& file) {
    return is_server_address(database) ? cut_from_server(database, region, file, {})
                                       : cut_from_file(database, region, file, {}, {});
}

std::vector<std::string> different_rows(const std::filesystem::path& a,
                                        const std::filesystem::path& b) {
    std::vector<std::string> rows;
    std::ranges::set_symmetric_difference(
        rows_of_tables(a), rows_of_tables(b), std::back_inserter(rows));
    std::erase_if(rows, [](const std::string& row) { return row.starts_with("audit|"); });
    return rows;
}

} // namespace macadam::testing
