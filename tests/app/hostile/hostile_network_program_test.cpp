// Networks that someone made to do harm, handed to the program as it is used.

#include "mapping/network/build_network.hpp"
#include "storage/networks/network_file.hpp"
#include "support/files/sealed_image.hpp"
#include "support/program/program.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <random>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string source(64, 'a');

/// A drive through the town as a log.
std::string drive_in(const fs::path& folder) {
    const auto roads = named_town();
    std::mt19937_64 random{7};
    const auto trip = recorded(roads, wander(roads, 6, random), {3, 1, false}, random);
    std::string log = "# macadam-trip 1\n# gnss_latency_s: 0\nt_s,lat_deg,lon_deg\n";
    for (const auto& fix : trip.fixes) {
        log += fmt::format("{:.1f},{:.7f},{:.7f}\n", fix.t_s, fix.at.lat_deg, fix.at.lon_deg);
    }
    write_file(folder / "drive.trip.csv", log + fmt::format("# end rows: {}\n", trip.fixes.size()));
    return (folder / "drive.trip.csv").string();
}

void write_bytes(const fs::path& file, const std::vector<std::byte>& bytes) {
    std::ofstream out{file, std::ios::binary};
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
}

/// Sealed, with the first link's node far beyond all nodes.
void point_nowhere(const fs::path& image_file) {
    const auto text = read_file(image_file);
    const auto bytes = std::as_bytes(std::span{text});
    std::vector<std::byte> image{bytes.begin(), bytes.end()};
    const auto links = section_of(image, 4);
    constexpr std::uint32_t nowhere = 0x7ffffff0;
    std::memcpy(image.data() + links.offset + 4, &nowhere, sizeof nowhere);
    seal(image);
    write_bytes(image_file, image);
}

std::string town_as_layer(const fs::path& folder) {
    std::string features;
    for (const auto& way : copies_of_ways(named_town())) {
        std::string places;
        for (const auto& at : way.line) {
            places +=
                fmt::format("{}[{:.7f},{:.7f}]", places.empty() ? "" : ",", at.lon_deg, at.lat_deg);
        }
        features += fmt::format(R"({}{{"type":"Feature","properties":{{"name":"{}"}},"geometry":)"
                                R"({{"type":"LineString","coordinates":[{}]}}}})",
                                features.empty() ? "" : ",",
                                way.name,
                                places);
    }
    write_file(folder / "town.geojson",
               R"({"type":"FeatureCollection","features":[)" + features + "]}");
    return (folder / "town.geojson").string();
}

} // namespace

TEST(HostileNetwork, GivenByItselfIsRefusedInWords) {
    const auto folder = fresh_folder();
    const auto image = folder / "roads-network";
    write_bytes(image, bytes_of(image_of(named_town(), source)));
    const auto trip = drive_in(folder);
    const auto good = run_macadam({"match", trip, "--network", image.string()});
    EXPECT_EQ(good.exit_status, 0) << good.err;
    point_nowhere(image);
    const auto bad = run_macadam({"match", trip, "--network", image.string()});
    EXPECT_EQ(bad.exit_status, 1);
    EXPECT_THAT(bad.err,
                AllOf(HasSubstr("roads-network: is not a valid network: link 0 is invalid"),
                      Not(HasSubstr("Sanitizer"))));
}

TEST(HostileNetwork, BesideAStoreIsMadeAgainFromItAndSaid) {
    const auto folder = fresh_folder();
    const auto store = (folder / "town.gpkg").string();
    const auto made = run_macadam({"init", store, "--network", town_as_layer(folder)});
    ASSERT_EQ(made.exit_status, 0) << made.err;
    const auto right = read_file(store + "-network");
    const auto trip = drive_in(folder);
    point_nowhere(store + "-network");
    const auto run = run_macadam({"match", trip, "--network", store});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err,
                HasSubstr("link 0 is invalid; its roads are read from the database instead"));
    EXPECT_EQ(read_file(store + "-network"), right);
}

TEST(HostileNetwork, OfOtherRoadsUnderTheStoresNameEndsInWordsAtMost) {
    const auto folder = fresh_folder();
    const auto store = (folder / "town.gpkg").string();
    ASSERT_EQ(run_macadam({"init", store, "--network", town_as_layer(folder)}).exit_status, 0);
    const auto hash = open_network_file(store + "-network").source;
    // The same roads by other ids: what is matched is in no table of the store.
    auto ways = copies_of_ways(named_town());
    for (auto& way : ways) {
        way.id += 5000;
    }
    write_network_file(build_network(ways), hash, store + "-network");
    const auto trip = drive_in(folder);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"match", trip, "--network", store},
          {"import", store, trip},
          {"info", store},
          {"query", store, "--road", "High Street"},
          {"query", store, "--along", trip},
          {"query", store, "--worst", "3"},
          {"report", store, "-o", (folder / "report.html").string()}}) {
        const auto run = run_macadam(words);
        EXPECT_LE(run.exit_status, 1) << words.front() << ": " << run.err;
        EXPECT_THAT(run.err, Not(HasSubstr("Sanitizer")));
    }
}

TEST(HostileNetwork, OfALineOf270000PointsIsARoad) {
    const auto folder = fresh_folder();
    std::string places;
    for (int i = 0; i < 270'000; ++i) {
        places += fmt::format("{}[15,{:.6f}]", i == 0 ? "" : ",", 48 + i * 1e-6);
    }
    write_file(folder / "long.geojson",
               R"({"type":"Feature","properties":{},"geometry":{"type":"LineString",)"
               R"("coordinates":[)" +
                   places + "]}}");
    const auto run = run_macadam(
        {"init", (folder / "a.gpkg").string(), "--network", (folder / "long.geojson").string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("1 way, 1 link"));
}

TEST(HostileNetwork, WithPointsFarApartIsReadWithoutThemAndSaid) {
    const auto folder = fresh_folder();
    const auto line = [](const char* places) {
        return fmt::format(R"({{"type":"Feature","properties":{{}},"geometry":)"
                           R"({{"type":"LineString","coordinates":[{}]}}}})",
                           places);
    };
    write_file(folder / "far.geojson",
               R"({"type":"FeatureCollection","features":[)" + line("[0,0],[179,0]") + "," +
                   line("[15,48],[15.001,48]") + "]}");
    const auto run = run_macadam(
        {"init", (folder / "a.gpkg").string(), "--network", (folder / "far.geojson").string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err,
                AllOf(HasSubstr("skipped: 1 way with points more than 50 km apart"),
                      HasSubstr("1 way, 1 link")));
}

} // namespace macadam::testing
