// One database on any processor: imports with the variants of libm that glibc chooses on others.

#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::SizeIs;

/// Features that glibc is told to see or not to see ("Hardware Capability Tunables" in its manual):
/// all of this processor, one before FMA, one before AVX2, one before AVX.
const char* const processors[] = {"+SSE2", "-FMA,-FMA4", "-AVX2", "-AVX,-AVX2,-FMA,-FMA4,-SSE4_1"};

/// Calls `digest_of()` as on each processor and returns the digests that come out.
template <typename DigestOf>
std::set<std::string> digests(const DigestOf& digest_of) {
    std::set<std::string> found;
    for (const auto* const features : processors) {
        setenv("GLIBC_TUNABLES", fmt::format("glibc.cpu.hwcaps={}", features).c_str(), 1);
        found.insert(digest_of());
    }
    unsetenv("GLIBC_TUNABLES");
    return found;
}

/// Returns what the program prints; it must succeed.
std::string output(const std::vector<std::string>& words) {
    const auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.out;
}

/// Returns the digest of a new database in `folder` with these trips.
/// \param network  words of `init` that say where the roads come from
std::string imported(const fs::path& folder,
                     const std::vector<std::string>& network,
                     const std::string& trips) {
    fs::remove_all(folder / "database");
    fs::create_directory(folder / "database");
    const auto store = (folder / "database/roads.gpkg").string();
    std::vector<std::string> init{"init", store};
    init.insert(init.end(), network.begin(), network.end());
    output(init);
    output({"import", store, trips, "--quiet"});
    return output({"info", store, "--digest"});
}

TEST(Processors, GiveOneDigestForATripOnTheRoadsThatItTraces) {
    const auto folder = fresh_folder();
    for (const auto* const trip :
         {"comma2k19/comma2k19_rav4.trip.csv", "gyor/gyor_q3_00.trip.csv"}) {
        const auto log = fmt::format("{}/sample_data/{}", source_folder(), trip);
        EXPECT_THAT(digests([&] {
                        return imported(folder, {"--trace", log}, log);
                    }),
                    SizeIs(1))
            << trip;
    }
}

TEST(Processors, GiveOneDigestForASimulatedFleet) {
    const auto folder = fresh_folder();
    // Of thirty trips of 8 km one pass in thousands differed; one short trip shows that they can be
    // imported.
    const bool all = std::getenv("MACADAM_TEST_ALL") != nullptr;
    const auto fleet = fmt::format("{}/sample_data/fleet", source_folder());
    auto recipe = (folder / "recipe.toml").string();
    write_file(recipe, "[trips]\ncount = 1\nlength_km = [2, 3]\n");
    if (all) {
        recipe = fleet + "/recipe.toml";
    }
    const auto roads = fleet + "/network.osm.pbf";
    output({"simulate", "-o", (folder / "fleet").string(), "--network", roads, "--recipe", recipe});
    const auto trips = (folder / "fleet/trips").string();
    EXPECT_THAT(digests([&] { return imported(folder, {"--network", roads}, trips); }), SizeIs(1));
}

TEST(Processors, GiveOneNetworkForALayerInMetresOnTheGround) {
    const auto folder = fresh_folder();
    std::string points;
    for (int i = 0; i < 2000; ++i) { // 15 km in UTM zone 33
        points += fmt::format("{}[{:.3f},{:.3f}]",
                              points.empty() ? "" : ",",
                              500'000 + 7.313 * i,
                              5'300'000 + 0.731 * (i * 37 % 101));
    }
    write_file(folder / "road.geojson",
               R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
               R"("urn:ogc:def:crs:EPSG::25833"}},"features":[{"type":"Feature","properties":)"
               R"({"highway":"road"},"geometry":{"type":"LineString","coordinates":[)" +
                   points + "]}}]}");
    const auto store = (folder / "database/roads.gpkg").string();
    EXPECT_THAT(digests([&] {
                    fs::remove_all(folder / "database");
                    fs::create_directory(folder / "database");
                    output({"init", store, "--network", (folder / "road.geojson").string()});
                    return output({"export", store, "--all", "--format", "geojson", "-o", "-"});
                }),
                SizeIs(1));
}

} // namespace
} // namespace macadam::testing
