#include "gdal_reading.hpp"

#include "support/program/shell.hpp"

#include <gtest/gtest.h>

namespace macadam::testing {

nlohmann::json collection_by_gdal(const std::filesystem::path& folder, const std::string& name) {
    const auto out = folder / (name + ".json");
    EXPECT_EQ(output_of(folder,
                        "ogr2ogr -f GeoJSON -lco RFC7946=NO -lco COORDINATE_PRECISION=9 " +
                            out.string() + " " + (folder / name).string() +
                            (name.ends_with(".gpkg") ? " roughness" : "")),
              "");
    return nlohmann::json::parse(content_of(out));
}

void expect_line(const nlohmann::json& coordinates,
                 const std::vector<GeoPoint>& line,
                 double tolerance_deg) {
    ASSERT_EQ(coordinates.size(), line.size());
    for (std::size_t i = 0; i < line.size(); ++i) {
        EXPECT_NEAR(coordinates[i][0].get<double>(), line[i].lon_deg, tolerance_deg);
        EXPECT_NEAR(coordinates[i][1].get<double>(), line[i].lat_deg, tolerance_deg);
    }
}

} // namespace macadam::testing
