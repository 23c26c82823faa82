#include "storage/trips/signals/hdf5_reader.hpp"

#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
const fs::path root{source_folder()};
const fs::path folder = root / "tests/data/hdf5";

const std::string head = "[hdf5]\ntimes = \"/imu/time\"\n"
                         "[time]\nformat = \"ns\"\nepoch = \"unix\"\n[channels]\n";
const std::string channels =
    "acc_x_mps2 = {signal = \"/imu/acc\", column = 1, unit = \"g\"}\n"
    "acc_y_mps2 = {signal = \"/link\", column = 2, unit = \"g\"}\n"
    "acc_z_mps2 = {signal = \"imu/acc\", column = 3, unit = \"g\"}\n"
    "lat_deg = {signal = \"/gnss/position\", column = 1, times = \"/gnss/time\"}\n"
    "lon_deg = {signal = \"/gnss/position\", column = 2, times = \"/gnss/time\"}\n"
    "gnss_speed_mps = {signal = \"/gnss/speed\", times = \"/gnss/time\", scale = 0.01}\n";

TripLog read(const fs::path& file, const std::string& toml = head + channels) {
    const auto of = std::make_shared<const TripMapping>(parse_mapping(toml, "car.toml"));
    return read_trip(find_trips(file, of).trips.at(0), everything);
}

std::string refusal(const fs::path& file, const std::string& toml = head + channels) {
    return refusal_of([&] { read(file, toml); });
}

const std::string one = "[hdf5]\ntimes = \"/t\"\n[channels]\nacc_z_mps2 = {signal = \"/acc\"}\n";

TEST(Hdf5, GivesTheDriveOfItsDatasets) {
    const auto trip = read(folder / "drive.h5");
    const auto from = read_trip(
        {.file = root / "sample_data/gyor/gyor_q3_00.trip.csv", .member = {}}, everything);
    const auto first = static_cast<std::size_t>(std::ranges::lower_bound(from.acc.t_s, 40.0) -
                                                from.acc.t_s.begin());
    const auto last = static_cast<std::size_t>(std::ranges::lower_bound(from.acc.t_s, 46.0) -
                                               from.acc.t_s.begin());
    ASSERT_THAT(trip.acc.t_s, SizeIs(last - first));
    for (std::size_t i = 0; i < last - first; ++i) {
        EXPECT_NEAR(
            trip.acc.t_s[i] - trip.acc.t_s[0], from.acc.t_s[first + i] - from.acc.t_s[first], 1e-6);
        EXPECT_NEAR(trip.acc.x[i], from.acc.x[first + i], 1e-5);
        EXPECT_NEAR(trip.acc.y[i], from.acc.y[first + i], 1e-5);
        EXPECT_NEAR(trip.acc.z[i], from.acc.z[first + i], 1e-5);
    }
    const auto fix = std::ranges::lower_bound(from.fixes, 40.0, {}, &GnssFix::t_s);
    ASSERT_THAT(trip.fixes, SizeIs(6));
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(trip.fixes[i].at, (fix + static_cast<std::ptrdiff_t>(i))->at);
        EXPECT_NEAR(
            trip.fixes[i].speed_mps, (fix + static_cast<std::ptrdiff_t>(i))->speed_mps, 0.006);
    }
    EXPECT_NEAR(*trip.meta.t0_utc_s, 1772352040, 0.02);
}

TEST(Hdf5, OpensNothingOutsideOfTheFile) {
    EXPECT_THAT(refusal(folder / "refused/external_link.h5", one),
                HasSubstr("external_link.h5: dataset '/acc': is not in the file (or in another"));
    EXPECT_THAT(refusal(folder / "refused/external_storage.h5", one),
                HasSubstr("dataset '/acc': is stored in another file"));
    EXPECT_THAT(refusal(folder / "refused/virtual.h5", one), HasSubstr("has a virtual layout"));
    EXPECT_THAT(refusal(folder / "refused/filter.h5", one),
                HasSubstr("uses the filter 32000, expected deflate, shuffle, fletcher32 or none"));
    EXPECT_THAT(refusal(folder / "refused/huge.h5", one),
                HasSubstr("has 1000000000000 rows of 1 numbers, expected at most"));
}

TEST(Hdf5, SaysWhatADatasetIsNot) {
    const auto with = [](const std::string& signal) {
        return refusal(folder / "drive.h5", head + "acc_z_mps2 = {" + signal + "}\n");
    };
    EXPECT_THAT(with("signal = \"/nowhere\""), HasSubstr("dataset '/nowhere': is not in the file"));
    EXPECT_THAT(with("signal = \"/text\""), HasSubstr("dataset '/text': has no numbers"));
    EXPECT_THAT(with("signal = \"/cube\""), HasSubstr("has 3 dimensions, expected 1 or 2"));
    EXPECT_THAT(with("signal = \"/gnss/speed\""),
                HasSubstr("dataset '/gnss/speed' has 6 rows of 1 numbers, expected"));
    EXPECT_THAT(with("signal = \"/imu/acc\", column = 4"), HasSubstr("and 4 or more numbers"));
    EXPECT_THAT(
        refusal(folder / "drive.h5", "[hdf5]\n[channels]\nacc_z_mps2 = {signal = \"/a\"}\n"),
        HasSubstr("times"));
}

TEST(Hdf5, RefusesDamagedFiles) {
    EXPECT_THAT(refusal(written(test_folder(), "a.h5", "\x89HDF\r\n\x1a\n"), one),
                HasSubstr("a.h5: is no HDF5 file, or damaged or truncated"));
    std::ifstream in{folder / "drive.h5", std::ios::binary};
    const std::string whole{std::istreambuf_iterator<char>{in}, {}};
    const auto half = written(test_folder(), "a.h5", whole.substr(0, whole.size() / 2));
    EXPECT_THAT(refusal(half), HasSubstr("damaged or truncated"));
}

} // namespace
} // namespace macadam::testing
