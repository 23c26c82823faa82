#include "storage/store/road_store.hpp"

#include "mapping/passes/trip_cutting.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/roughness_pattern.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace macadam {
namespace {

using testing::add_trip;
using ::testing::HasSubstr;
using testing::refusal_of;
using ::testing::SizeIs;
using testing::test_folder;
using testing::trip_record;

/// 600 m of road both ways: a chunk of 25 segments and one of 5 in each direction.
const RoadNetwork& roads() {
    static const auto art = testing::road_art("A---------B", 60, {"AB"});
    return art.roads;
}

RoadStore new_store(const std::filesystem::path& file) {
    return RoadStore::create(file, roads(), testing::settings());
}

struct Trip {
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
};

/// The mean of what a trace has between two stations.
IriUm mean_um(const RoughnessTrace& trace, double from_m, double to_m) {
    Pass pass{};
    pass.iri_um = 1;
    return moved(pass, from_m, to_m, trace, 1e-9, 1e-9).iri_um;
}

/// A trip along the whole road that reads `lag_m` too far on, forward or backward.
Trip driven(int number, double lag_m, bool forward) {
    static const auto pattern = testing::roughness_pattern(700, 77);
    constexpr double shift_m = 650; // stations of the way back are below 0
    Trip trip;
    const auto segments = segments_of(roads(), edge_of(LinkId{0}, forward));
    for (const auto& segment : segments) {
        const auto chunk = chunk_of(segment.key, 20);
        if (trip.traces.empty() || trip.traces.back().chunk != chunk) {
            const bool first = chunk.number == 0;
            const double from_m = forward ? (first ? 0 : 490) : (first ? -510 : -600);
            const double to_m = forward ? (first ? 510 : 600) : (first ? 0 : -490);
            const double offset_m = forward ? 20 : shift_m;
            auto trace = testing::read_pattern(
                pattern,
                {.from_m = from_m + offset_m,
                 .to_m = to_m + offset_m,
                 .lag_m = [lag_m](double) { return lag_m; },
                 .seed = static_cast<std::uint64_t>(100 * number) + chunk.number});
            trace.first_m = static_cast<std::int32_t>(from_m);
            trace.chunk = chunk;
            trip.traces.push_back(trace);
        }
        const auto station = [&](double along_m) { return station_m(forward, along_m); };
        const auto um = mean_um(trip.traces.back(),
                                station(forward ? segment.from_m : segment.to_m),
                                station(forward ? segment.to_m : segment.from_m));
        trip.passes.push_back({.segment = segment.key,
                               .occurrence = 0,
                               .iri_left_um = {},
                               .iri_right_um = {},
                               .iri_centre_um = {},
                               .iri_um = um,
                               .sd_um = um / 10,
                               .centre_only = false,
                               .validity = 0,
                               .speed_mmps = 15000,
                               .covered_mm = 20000,
                               .confidence_ppm = 990000,
                               .t_ms = 1000,
                               .drive = 0});
    }
    return trip;
}

constexpr std::array lags_m{0.0, 4.0, -3.0, 1.5, -5.0, 2.5};

void add(RoadStore& store, int number) {
    for (const bool forward : {true, false}) {
        const auto trip = driven(number, lags_m.at(static_cast<std::size_t>(number)), forward);
        auto record = trip_record(2 * number + (forward ? 1 : 0));
        add_trip(store, record, trip.passes, trip.traces);
    }
}

RoadStore store_of(const std::filesystem::path& file, const std::vector<int>& order) {
    auto store = new_store(file);
    for (const int number : order) {
        add(store, number);
    }
    store.importer.refresh();
    return store;
}

TEST(ChunkStore, ComesToTheSameInAnyOrderAndInAnyBatches) {
    const auto folder = test_folder();
    std::vector<int> order(lags_m.size());
    std::iota(order.begin(), order.end(), 0);
    const auto digest = store_of(folder / "straight.gpkg", order).digest();
    std::mt19937 random{5};
    for (unsigned round = 0; round < 4; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        auto store = new_store(folder / ("shuffled" + std::to_string(round) + ".gpkg"));
        for (const int number : order) {
            add(store, number);
            if ((number + static_cast<int>(round)) % 2 == 0) {
                store.importer.refresh();
            }
        }
        store.importer.refresh();
        EXPECT_EQ(store.digest(), digest);
    }
}

TEST(ChunkStore, ComesToTheSameAlsoWhereATripHasATraceButNoPass) {
    const auto store_fused = [](const std::filesystem::path& file, bool each) {
        auto store = new_store(file);
        add(store, 0);
        add(store, 1);
        if (each) {
            store.importer.refresh();
        }
        auto trip = driven(2, lags_m[2], true);
        trip.passes.resize(3); // all in the first chunk
        add_trip(store, trip_record(5), trip.passes, trip.traces);
        store.importer.refresh();
        return store.digest();
    };
    const auto folder = test_folder();
    EXPECT_EQ(store_fused(folder / "each.gpkg", true), store_fused(folder / "all.gpkg", false));
}

TEST(ChunkStore, TellsTheLagOfEachPass) {
    const auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2, 3, 4, 5});
    for (const SegmentKey key : {SegmentKey{1, true, 12}, {1, false, 12}, {1, true, 27}}) {
        const auto passes = store.history(key);
        ASSERT_THAT(passes, SizeIs(6));
        std::map<std::string, double> lag_of;
        for (const auto& record : passes) {
            lag_of[record.trip_sha256] = record.lag_m.value();
        }
        const auto lag = [&](int number) {
            return lag_of.at(trip_record(2 * number + (key.forward ? 1 : 0)).sha256);
        };
        for (int number = 1; number < 6; ++number) {
            // Of 100 m (the short chunk) with a third of noise.
            EXPECT_NEAR(lag(number) - lag(0), lags_m.at(static_cast<std::size_t>(number)), 1)
                << name_of(key);
        }
    }
}

TEST(ChunkStore, TellsHowFarPassesWereMoved) {
    const auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2, 3, 4, 5});
    const auto alignment = store.alignment();
    EXPECT_EQ(alignment.drives, 6 * 4); // two chunks in each direction
    EXPECT_EQ(alignment.found, alignment.drives);
    EXPECT_EQ(alignment.beyond_reach, 0);
    // About their mean of 0 the trips lie at 0, 4, -3, 1.5, -5 and 2.5 m: four beyond 2 m.
    EXPECT_EQ(alignment.moved_far, 4 * 4);
    EXPECT_GE(alignment.middle_lag_cm, 250 - 30);
    EXPECT_LE(alignment.middle_lag_cm, 300 + 30);
    EXPECT_EQ(store.info().alignment.found, alignment.found);
    EXPECT_EQ(store.history({1, true, 12})[0].finding, LagStatus::found);
}

TEST(ChunkStore, TellsOfNoLagsWhereOneTripDroveAlone) {
    const auto alignment = store_of(test_folder() / "a.gpkg", {1}).alignment();
    EXPECT_EQ(alignment.drives, 4);
    EXPECT_EQ(alignment.found, 0);
    EXPECT_EQ(alignment.middle_lag_cm, 0);
}

TEST(ChunkStore, KeepsAPassAsItsTripReadIt) {
    const auto store = store_of(test_folder() / "a.gpkg", {0, 1});
    const auto trip = driven(1, lags_m[1], true);
    const auto passes = store.history({1, true, 12});
    ASSERT_THAT(passes, SizeIs(2));
    const auto mine = std::ranges::find(passes, trip_record(3).sha256, &HistoricPass::trip_sha256);
    ASSERT_NE(mine, passes.end());
    EXPECT_EQ(mine->pass.iri_um, trip.passes[12].iri_um);
}

TEST(ChunkStore, FusesPassesWhereTheyLie) {
    // All pairs of trips read the same road 5 m and more apart. Laid on each other they differ
    // less.
    const auto scatter = [](const StoreReader& store) {
        double sum = 0;
        store.visit({}, [&](const SegmentRecord& record) {
            sum += record.state->sd_um / double(record.state->iri_um);
        });
        return sum;
    };
    const auto folder = test_folder();
    const auto aligned = store_of(folder / "aligned.gpkg", {0, 1, 2, 3, 4, 5});
    auto apart = new_store(folder / "apart.gpkg");
    for (int number = 0; number < 6; ++number) {
        for (const bool forward : {true, false}) {
            add_trip(apart,
                     trip_record(2 * number + (forward ? 1 : 0)),
                     driven(number, lags_m.at(static_cast<std::size_t>(number)), forward).passes);
        }
    }
    apart.importer.refresh();
    EXPECT_LT(scatter(aligned), scatter(apart));
}

TEST(ChunkStore, LeavesASingleTripAsItIs) {
    const auto store = store_of(test_folder() / "a.gpkg", {1});
    const auto trip = driven(1, lags_m[1], true);
    store.visit({.box = {}, .way_id = {}, .key = SegmentKey{1, true, 7}, .name_part = {}},
                [&](const SegmentRecord& record) {
                    EXPECT_EQ(record.state->iri_um, trip.passes[7].iri_um);
                });
    EXPECT_EQ(store.history({1, true, 7})[0].lag_m, 0.0);
}

TEST(ChunkStore, CountsTheSegmentsThatHadNewPasses) {
    auto store = store_of(test_folder() / "a.gpkg", {0});
    auto trip = driven(1, lags_m[1], true);
    trip.passes.resize(3);
    add_trip(store, trip_record(3), trip.passes, trip.traces);
    EXPECT_EQ(store.waiting(), 3U);
    EXPECT_EQ(store.importer.refresh(), 3U);
    EXPECT_EQ(store.waiting(), 0U);
}

TEST(ChunkStore, RefusesTracesOfOtherRoadsAndTakesNothingOfTheTrip) {
    auto store = new_store(test_folder() / "a.gpkg");
    auto trip = driven(0, 0, true);
    trip.traces[0].chunk.way_id = 99;
    EXPECT_THAT(refusal_of([&] { add_trip(store, trip_record(1), trip.passes, trip.traces); }),
                HasSubstr("a.gpkg: has no strip 0 of way '99' forward, expected traces over its "
                          "own network"));
    EXPECT_FALSE(store.contains_trip(trip_record(1).sha256));
}

TEST(ChunkStore, SaysThatATraceWasChanged) {
    const auto file = test_folder() / "a.gpkg";
    for (const char* change : {"first_m = 99000000",
                               "first_m = first_m - 400000 * (drive = 7)",
                               "iri = x''",
                               "iri_left = x'01'",
                               "place_sd_mm = 0"}) {
        std::filesystem::remove(file);
        auto store = new_store(file);
        add(store, 0);
        auto again = driven(1, 0, true);
        again.traces.resize(1);
        again.traces[0].drive = 7;
        add_trip(store, trip_record(9), again.passes, again.traces);
        Database{file, Database::Access::write}.run(std::string{"UPDATE trace SET "} + change);
        EXPECT_THAT(refusal_of([&] { store.importer.refresh(); }),
                    HasSubstr("the database was modified"))
            << change;
    }
}

} // namespace
} // namespace macadam
