// What a simulated fleet is written as, and read back from.

#include "estimator/common/error.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/networks/osm_writer.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "storage/surveys/truth_file.hpp"
#include "support/files/files.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <iterator>

using namespace macadam;
using namespace macadam::testing;
using ::testing::HasSubstr;

namespace {

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// Ways on the grid of 1e-7 degrees that the format has.
std::vector<Way> ways() {
    const auto on_grid = [](double degrees) { return std::round(degrees * 1e7) / 1e7; };
    auto ways = road_art("A---B---C---D", 100, {"AB", "BC>", "CD"}).ways;
    for (auto& way : ways) {
        for (auto& point : way.line) {
            point = {on_grid(point.lat_deg), on_grid(point.lon_deg)};
        }
    }
    ways[0].name = "Untere Landstraße";
    ways[0].highway = "residential";
    ways[0].speed_limit_cmps = 1389; // 50 km/h
    ways[0].turns = {{'B', 1, 0}, {'B', 2, 1}};
    ways[1].highway = "motorway";
    ways[2].highway = "track";
    ways[2].oneway = Oneway::backward;
    return ways;
}

const std::string header = std::string{truth_header} + "\n";

std::vector<SegmentTruth> read_rows(const std::string& text) {
    return read_truth(written(test_folder(), "truth.csv", text));
}

std::string refusal_of_rows(const std::string& text) {
    return refusal_of([&] { read_rows(text); });
}

} // namespace

TEST(OsmWriter, IsReadBackAsTheSameWays) {
    const auto file = test_folder() / "network.osm.pbf";
    write_osm(ways(), file);
    const auto expected = ways();
    const auto read = read_network(file);
    ASSERT_EQ(read.size(), expected.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].id, expected[i].id);
        EXPECT_EQ(read[i].name, expected[i].name);
        EXPECT_EQ(read[i].highway, expected[i].highway);
        EXPECT_EQ(read[i].oneway, expected[i].oneway);
        EXPECT_EQ(read[i].node_ids, expected[i].node_ids);
        EXPECT_EQ(read[i].line, expected[i].line);
        EXPECT_EQ(read[i].speed_limit_cmps, expected[i].speed_limit_cmps);
        EXPECT_EQ(read[i].turns, expected[i].turns);
    }
}

TEST(OsmWriter, KeepsEverySpeedLimitToTheCentimetre) {
    const auto file = test_folder() / "network.osm.pbf";
    for (std::uint16_t cmps = 7; cmps < 6944; cmps = static_cast<std::uint16_t>(cmps + 331)) {
        auto limited = ways();
        limited[1].speed_limit_cmps = cmps;
        write_osm(limited, file);
        EXPECT_EQ(read_network(file)[1].speed_limit_cmps, cmps);
    }
}

TEST(OsmWriter, LetsATwoWayMotorwayBeOne) {
    auto two_way = ways();
    two_way[1].oneway = Oneway::no;
    const auto file = test_folder() / "network.osm.pbf";
    write_osm(two_way, file);
    EXPECT_EQ(read_network(file)[1].oneway, Oneway::no);
}

TEST(OsmWriter, CallsAClassThatOsmDoesNotKnowARoad) {
    auto other = ways();
    other[0].highway = "Landesstraße";
    other[1].highway = "";
    const auto file = test_folder() / "network.osm.pbf";
    write_osm(other, file);
    EXPECT_EQ(read_network(file)[0].highway, "road");
    EXPECT_EQ(read_network(file)[1].highway, "road");
}

TEST(OsmWriter, GivesEqualBytesForEqualWays) {
    const auto folder = test_folder();
    write_osm(ways(), folder / "a.osm.pbf");
    write_osm(ways(), folder / "b.osm.pbf");
    EXPECT_EQ(bytes_of(folder / "a.osm.pbf"), bytes_of(folder / "b.osm.pbf"));
}

TEST(OsmWriter, SaysWhereItCannotWrite) {
    const auto file = test_folder() / "missing" / "network.osm.pbf";
    EXPECT_THAT(refusal_of([&] { write_osm(ways(), file); }),
                HasSubstr("network.osm.pbf: cannot be written: No such file or directory"));
}

TEST(VehicleWriter, IsReadBackAsTheSameCar) {
    auto car = *built_in_vehicle("suv");
    car.name = "suv-3";
    car.one_axle_gain = 0.72;
    car.half_car.antiroll_n_per_m = 8000;
    car.half_car.friction_n = 0;
    car.axles =
        Axles{.wheelbase_m = 2.75, .cg_to_front_m = 1.3, .dynamic_index = 1.1, .rear_ratio = 0.9};
    car.imu = {.x_m = 0.1, .y_m = -0.2, .height_above_roll_axis_m = 0.5, .lowpass_hz = 40};
    const auto read = read_vehicle(written(test_folder(), "suv-3.toml", vehicle_text(car)));
    EXPECT_EQ(read.name, car.name);
    EXPECT_EQ(read.gain, car.gain);
    EXPECT_EQ(read.one_axle_gain, car.one_axle_gain);
    EXPECT_EQ(read.half_car.is_kgm2, car.half_car.is_kgm2);
    EXPECT_EQ(read.half_car.antiroll_n_per_m, 8000);
    EXPECT_EQ(read.half_car.friction_n, 0) << "none, which is not the same as not known";
    EXPECT_EQ(read.axles->dynamic_index, 1.1);
    EXPECT_EQ(read.axles->rear_ratio, 0.9);
    EXPECT_EQ(read.imu.y_m, -0.2);
    EXPECT_EQ(read.imu.lowpass_hz, 40);
    EXPECT_EQ(read.uncertainty, car.uncertainty);
}

TEST(VehicleWriter, KeepsThatASensorHasNoLowPassAndThatItsLowPassIsNotKnown) {
    auto car = *built_in_vehicle("suv");
    for (const double lowpass_hz : {0.0, no_lowpass_hz}) {
        car.imu.lowpass_hz = lowpass_hz;
        const auto read = read_vehicle(written(test_folder(), "suv.toml", vehicle_text(car)));
        EXPECT_EQ(read.imu.lowpass_hz, lowpass_hz);
    }
}

TEST(TruthFile, IsReadBackInTheOrderOfItsKeys) {
    const std::vector<SegmentTruth> truth{
        {{12, true, 0}, 0, 20.5, 1.25, 2.25, 1.75, 1.5},
        {{12, false, 0}, 0, 20.5, 3, 3, 3, 2.5},
    };
    const auto rows = truth_rows(truth);
    EXPECT_EQ(rows,
              "12+0000,12,forward,0.000,20.500,1.250,2.250,1.750,1.500\n"
              "12-0000,12,backward,0.000,20.500,3.000,3.000,3.000,2.500\n");
    const auto split = rows.find('\n') + 1;
    const auto read = read_rows(header + rows.substr(split) + rows.substr(0, split));
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].key, truth[0].key);
    EXPECT_EQ(read[0].mri, 1.75);
    EXPECT_EQ(read[1].to_m, 20.5);
}

TEST(TruthFile, MayKnowTheMriAlone) {
    const auto read = read_rows(header + "12+0000,12,forward,0,20,,,1.75,\n");
    EXPECT_EQ(read[0].mri, 1.75);
    EXPECT_TRUE(std::isnan(read[0].iri_left));
}

TEST(TruthFile, SaysWhatIsWrongAndWhere) {
    EXPECT_THAT(refusal_of_rows("segment,iri\n"),
                HasSubstr("truth.csv:1: 'segment,iri', expected the header 'segment,way_id"));
    EXPECT_THAT(refusal_of_rows(header + "12+0000,12,forward,0,20,1,1,rough,1\n"),
                HasSubstr("truth.csv:2: 'rough', expected an IRI in mm/m"));
    EXPECT_THAT(refusal_of_rows(header + "12+0000,12,forward,0,20,1,1,,1\n"),
                HasSubstr("truth.csv:2: '', expected an IRI in mm/m"));
    EXPECT_THAT(refusal_of_rows(header + "twelve,12,forward,0,20,1,1,1,1\n"),
                HasSubstr("truth.csv:2: 'twelve', expected a segment such as '123456+0007'"));
    EXPECT_THAT(refusal_of_rows(header + "12+0000,12,forward\n"),
                HasSubstr("truth.csv:2: only 3 cells, expected 9"));
    EXPECT_THAT(refusal_of_rows(header + "12+0000,12,forward,20,20,1,1,1,1\n"),
                HasSubstr("truth.csv:2: to_m is '20', expected more than from_m, '20'"));
    const std::string row = "12+0000,12,forward,0,20,1,1,1,1\n";
    EXPECT_THAT(refusal_of_rows(header + row + row), HasSubstr("segment '12+0000' occurs twice"));
}
