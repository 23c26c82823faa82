// Databases that somebody spoilt, under every command that takes one: each ends with 0, or with 1
// and words, within 25 s and a GB. The ordinary tests try one of each way; `./run test --all` 603.

#include "hostile_database.hpp"

#include "storage/networks/network_file.hpp"
#include "support/program/bounded_run.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

using namespace macadam;
using namespace macadam::testing;

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

/// Readers first; what writes then works on what is left.
const std::vector<Words> commands{
    {"info", "a.gpkg"},
    {"info", "a.gpkg", "--json"},
    {"info", "a.gpkg", "--audit"},
    {"query", "a.gpkg", "--worst", "5"},
    {"query", "a.gpkg", "--bbox=4,44,5,46", "--all", "--format", "geojson"},
    {"query", "a.gpkg", "--segment", "1+0003", "--passes"},
    {"query", "a.gpkg", "--way", "1", "--history"},
    {"export", "a.gpkg", "-o", "a.geojson"},
    {"export", "a.gpkg", "-o", "b.gpkg"},
    {"export", "a.gpkg", "-o", "a.pmtiles"},
    {"render", "a.gpkg", "-o", "a.png", "--size", "256x256"},
    {"report", "a.gpkg", "-o", "a.html", "--worst", "1"},
    {"import", "a.gpkg", "a.trip.csv"},
    {"calibrate", "a.gpkg"},
    {"reprocess", "a.gpkg", "a.trip.csv"},
    {"valid-from", "a.gpkg", "--since", "2026-05-01", "--way", "1"},
    {"forget", "a.gpkg", "--trip", "trip-1"},
    {"info", "a.gpkg", "--digest"},
};

fs::path good_database(const fs::path& folder) {
    auto file = folder / "good.gpkg";
    auto store = new_store(file);
    import_trips(store, 4);
    cache_network(store, small_country());
    return file;
}

bool is_alarm(std::string_view words) {
    constexpr std::array<std::string_view, 3> marks{"Sanitizer", "runtime error:", "terminate"};
    return std::ranges::any_of(
        marks, [&](auto mark) { return words.find(mark) != std::string_view::npos; });
}

void expect_sound_end(const BoundedRun& run) {
    constexpr double max_mb = 1024;
    EXPECT_FALSE(run.too_long);
    EXPECT_LE(run.exit_status, 1) << run.err;
    EXPECT_FALSE(is_alarm(run.err)) << run.err;
    EXPECT_TRUE(run.exit_status == 0 || !run.err.empty()) << "a refusal has words";
    EXPECT_LT(run.peak_mb, max_mb);
}

struct Way {
    Spoiling spoiling;
    std::string_view name;
};

constexpr std::array ways{Way{Spoiling::bytes, "bytes"},
                          Way{Spoiling::pages, "pages"},
                          Way{Spoiling::length, "length"},
                          Way{Spoiling::cells, "cells"},
                          Way{Spoiling::columns, "columns"},
                          Way{Spoiling::blobs, "blobs"},
                          Way{Spoiling::schema, "schema"},
                          Way{Spoiling::masses, "masses"},
                          Way{Spoiling::journals, "journals"}};

void PrintTo(const Way& way, std::ostream* out) {
    *out << way.name;
}

class HostileDatabases : public ::testing::TestWithParam<Way> {};

TEST_P(HostileDatabases, AreReadOrRefusedByEveryCommand) {
    constexpr std::chrono::seconds longest{25};
    constexpr std::uint64_t all_of_a_way = 67; // of nine ways: 603
    const std::uint64_t count = std::getenv("MACADAM_TEST_ALL") != nullptr ? all_of_a_way : 1;
    const auto folder = fresh_folder();
    const auto good = good_database(folder);
    for (std::uint64_t number = 0; number < count; ++number) {
        const auto work = folder / "work";
        fs::remove_all(work);
        fs::create_directories(work);
        fs::copy_file(good, work / "a.gpkg");
        fs::copy_file(source_folder() + "/tests/fuzz/seeds/trip_trace/receiver.csv",
                      work / "a.trip.csv");
        const auto done = spoil(work / "a.gpkg", GetParam().spoiling, number);
        for (const auto& words : commands) {
            SCOPED_TRACE("database " + std::to_string(number) + " (" + done + "), " + words[0]);
            expect_sound_end(run_bounded(work, words, longest));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, HostileDatabases, ::testing::ValuesIn(ways), [](const auto& each) {
    return std::string{each.param.name};
});

} // namespace
