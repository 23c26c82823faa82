#include "storage/store/road_store.hpp"

#include "storage/files/sha256.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

namespace macadam {
namespace {

using testing::add_trip;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::import_trips;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using testing::new_store;
using ::testing::Not;
using testing::passes_of;
using testing::refusal_of;
using ::testing::SizeIs;
using testing::test_folder;
using testing::trip_record;

std::vector<SegmentRecord> records_of(const StoreReader& store, const SegmentFilter& filter = {}) {
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

std::vector<std::string> keys_of(const StoreReader& store, const SegmentFilter& filter) {
    std::vector<std::string> keys;
    for (const auto& record : records_of(store, filter)) {
        keys.push_back(name_of(record.segment.key));
    }
    return keys;
}

SegmentFilter all_segments() {
    return {.box = {}, .way_id = {}, .key = {}, .name_part = {}, .with_state_only = false};
}

TEST(RoadStore, AddsUpWhyRowsEnteredNoEstimate) {
    auto store = new_store(test_folder() / "a.gpkg");
    EXPECT_TRUE(store.usage().row_reasons.empty());
    for (int i = 0; i < 2; ++i) {
        auto trip = trip_record(i);
        trip.row_reasons = {{"too_slow", 10U + i}, {i == 0 ? "no_speed" : "merged", 1}};
        add_trip(store, trip, passes_of(i));
    }
    const std::map<std::string, std::size_t> sums{{"merged", 1}, {"no_speed", 1}, {"too_slow", 21}};
    EXPECT_EQ(store.usage().row_reasons, sums);
}

TEST(RoadStore, CountsPassesThatRestOnLateralVibrationAlone) {
    auto store = new_store(test_folder() / "a.gpkg");
    auto passes = passes_of(0);
    passes.front().validity = validity::indicative | validity::lateral_alone;
    add_trip(store, trip_record(0), passes);
    EXPECT_EQ(store.info().lateral_passes, 1U);
}

TEST(RoadStore, GivesBackTheNetworkThatItWasMadeWith) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    const auto made = testing::small_country();
    const auto kept = StoreReader::open(file).roads();
    ASSERT_EQ(way_count(kept), way_count(made));
    for (std::uint32_t i = 0; i < way_count(made); ++i) {
        const auto one = copy_of(way_at(kept, i));
        const auto other = copy_of(way_at(made, i));
        EXPECT_EQ(one.id, other.id);
        EXPECT_EQ(one.name, other.name);
        EXPECT_EQ(one.highway, other.highway);
        EXPECT_EQ(one.oneway, other.oneway);
        EXPECT_EQ(one.node_ids, other.node_ids);
        EXPECT_EQ(one.line, other.line);
        EXPECT_EQ(one.speed_limit_cmps, other.speed_limit_cmps);
        EXPECT_EQ(one.turns, other.turns);
    }
    EXPECT_EQ(link_count(kept), link_count(made));
    EXPECT_EQ(kept.segment_length_m, made.segment_length_m);
}

TEST(RoadStore, HoldsEverySegmentThatMayBeDriven) {
    const auto store = new_store(test_folder() / "a.gpkg");
    const auto roads = testing::small_country();
    std::vector<Segment> expected;
    for (std::uint32_t edge = 0; edge < 2 * link_count(roads); ++edge) {
        if (is_drivable(roads, EdgeId{edge})) {
            const auto segments = segments_of(roads, EdgeId{edge});
            expected.insert(expected.end(), segments.begin(), segments.end());
        }
    }
    std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
        return a.key < b.key;
    });
    const auto records = records_of(store, all_segments());
    ASSERT_EQ(records.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(records[i].segment.key, expected[i].key);
        EXPECT_EQ(records[i].segment.line, expected[i].line);
        EXPECT_EQ(records[i].segment.from_m, expected[i].from_m);
        EXPECT_EQ(records[i].segment.to_m, expected[i].to_m);
    }
}

TEST(RoadStore, KeepsPassesAndStatesToTheLastDigit) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 8);
    const auto records = records_of(store);
    ASSERT_THAT(records, SizeIs(20));
    std::map<std::string, std::int64_t> cars;
    for (const auto& car : store.usage().cars) {
        cars.emplace(car, cars.size());
    }
    for (const auto& record : records) {
        std::vector<FusionInput> inputs;
        for (const auto& known : store.history(record.segment.key)) {
            inputs.push_back({known.pass, known.trip_sha256, cars.at(known.vehicle), known.utc_ms});
            inputs.back().by_filter = true; // the method of trip_record()
        }
        EXPECT_EQ(record.state, fuse(inputs, {}));
    }
}

TEST(RoadStore, TellsTheHistoryInTheOrderOfTripHashes) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 5);
    const auto history = store.history({1, false, 3});
    ASSERT_THAT(history, SizeIs(5));
    EXPECT_TRUE(std::is_sorted(history.begin(), history.end(), [](const auto& a, const auto& b) {
        return a.trip_sha256 < b.trip_sha256;
    }));
    for (const auto& record : history) {
        int number = 0;
        while (trip_record(number).sha256 != record.trip_sha256) {
            ++number;
        }
        const auto pass = passes_of(number)[13];
        EXPECT_EQ(record.pass.iri_um, pass.iri_um);
        EXPECT_EQ(record.pass.iri_left_um, pass.iri_left_um);
        EXPECT_EQ(record.pass.iri_centre_um, std::nullopt);
        EXPECT_EQ(record.pass.speed_mmps, pass.speed_mmps);
        const auto t0 = trip_record(number).t0_utc_ms;
        EXPECT_EQ(record.utc_ms, t0 ? std::optional{*t0 + 3000} : std::nullopt);
    }
}

TEST(RoadStore, GivesOneDigestForEveryOrderOfImport) {
    const auto folder = test_folder();
    auto straight = new_store(folder / "straight.gpkg");
    import_trips(straight, 12);
    std::vector<int> order(12);
    std::iota(order.begin(), order.end(), 0);
    std::mt19937 random{3};
    for (int round = 0; round < 3; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        auto store = new_store(folder / ("shuffled" + std::to_string(round) + ".gpkg"));
        for (const int number : order) {
            add_trip(store, trip_record(number), passes_of(number));
            if (number % 5 == 0) {
                store.importer.refresh();
            }
        }
        store.importer.refresh();
        EXPECT_EQ(store.digest(), straight.digest());
    }
}

TEST(RoadStore, DigestsTheTextThatTheDocumentationDescribes) {
    auto store = new_store(test_folder() / "a.gpkg");
    auto pass = passes_of(0)[0];
    pass.iri_right_um.reset();
    const PassEvent event{.segment = pass.segment,
                          .occurrence = 0,
                          .kind = EventKind::bump,
                          .track = WheelTrack::both,
                          .at_mm = 12'345,
                          .place_sd_mm = 900,
                          .size_um = 31'000,
                          .sd_um = 9'500,
                          .length_mm = 1'500};
    add_trip(store, trip_record(3), std::vector{pass}, {}, std::vector{event});
    store.importer.refresh();
    const auto optional = [](const auto& value) { return value ? std::to_string(*value) : "-"; };
    const auto state = *records_of(store)[0].state;
    std::string text = "pass 1+0000 " + trip_record(3).sha256 + " 0 " +
                       std::to_string(*pass.iri_left_um) + " - - " + std::to_string(pass.iri_um) +
                       " " + std::to_string(pass.sd_um) + " 0 0 " +
                       std::to_string(pass.speed_mmps) + " 20000 990000 0\n";
    text += "state 1+0000 " + std::to_string(state.iri_um) + " " + std::to_string(state.sd_um) +
            " " + std::to_string(state.low_um) + " " + std::to_string(state.high_um) + " " +
            optional(state.left_um) + " - 0 0 1 1 - - - - - -\n";
    text += "searched " + trip_record(3).sha256 + "\nevent 1+0000 " + trip_record(3).sha256 +
            " 0 1 3 12345 900 31000 9500 1500\n";
    Sha256 hash;
    hash.add(text);
    EXPECT_EQ(store.digest(), hash.hex());
}

TEST(RoadStore, TakesEachTripOnce) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 3);
    const auto before = store.digest();
    EXPECT_TRUE(store.contains_trip(trip_record(1).sha256));
    EXPECT_FALSE(store.contains_trip(trip_record(3).sha256));
    EXPECT_FALSE(add_trip(store, trip_record(1), passes_of(2)));
    EXPECT_EQ(store.importer.refresh(), 0U);
    EXPECT_EQ(store.digest(), before);
    EXPECT_EQ(store.info().trips, 3U);
}

TEST(RoadStore, LetsTwoWritersWriteInTurn) {
    const auto folder = test_folder();
    auto alone = new_store(folder / "alone.gpkg");
    import_trips(alone, 6);
    auto one = new_store(folder / "shared.gpkg");
    auto other = RoadStore::open(folder / "shared.gpkg");
    for (int number = 0; number < 6; ++number) {
        add_trip(number % 2 == 0 ? one : other, trip_record(number), passes_of(number));
    }
    EXPECT_FALSE(add_trip(other, trip_record(0), passes_of(0)));
    one.importer.refresh();
    EXPECT_EQ(other.digest(), alone.digest());
}

TEST(RoadStore, CountsWhatWaitsToBeFused) {
    auto store = new_store(test_folder() / "a.gpkg");
    add_trip(store, trip_record(0), passes_of(0));
    EXPECT_EQ(store.info().waiting, 20U);
    EXPECT_EQ(store.importer.refresh(), 20U);
    EXPECT_EQ(store.info().waiting, 0U);
}

TEST(RoadStore, RecordsTheFusionsOfOneImportTogetherAndItsSegmentsOnce) {
    auto store = new_store(test_folder() / "a.gpkg");
    FusionRecord record;
    for (int number = 0; number < 3; ++number) {
        add_trip(store, trip_record(number), passes_of(number));
        EXPECT_EQ(store.importer.refresh({}, record), 20U);
    }
    EXPECT_THAT(record.segments, SizeIs(20));
    ASSERT_THAT(store.audit(), SizeIs(1));
    EXPECT_EQ(store.audit().front().segments, 20U);
}

TEST(RoadStore, RecordsWhatAnImportChangesAfterAnotherOperationAfterIt) {
    auto store = new_store(test_folder() / "a.gpkg");
    FusionRecord record;
    add_trip(store, trip_record(0), passes_of(0));
    store.importer.refresh({}, record);
    const auto segment = passes_of(0).front().segment;
    store.maintenance.set_valid_from({&segment, 1}, 0, "resurfaced");
    add_trip(store, trip_record(1), passes_of(1));
    store.importer.refresh({}, record);
    const auto entries = store.audit();
    ASSERT_THAT(entries, SizeIs(3));
    EXPECT_EQ(entries[0].what, "import");
    EXPECT_EQ(entries[2].what, "import");
}

TEST(RoadStore, FusesNoMoreThanIsWanted) {
    auto store = new_store(test_folder() / "a.gpkg");
    add_trip(store, trip_record(0), passes_of(0));
    std::stop_source source;
    source.request_stop();
    EXPECT_EQ(store.importer.refresh({.report = {}, .stop = source.get_token()}), 0U);
    EXPECT_EQ(store.info().waiting, 20U);
}

TEST(RoadStore, KnowsCarsOnlyByPseudonyms) {
    const auto file = test_folder() / "a.gpkg";
    auto store = new_store(file);
    auto secret = trip_record(0);
    secret.vehicle_id = "WVWZZZ1JZXW000001";
    add_trip(store, secret, passes_of(0));
    auto nobody = trip_record(1);
    nobody.vehicle_id = "";
    add_trip(store, nobody, passes_of(1));
    EXPECT_THAT(store.info().vehicles, ElementsAre(MatchesRegex("v-[0-9a-f]{32}"), "unknown"));
    std::ifstream in{file, std::ios::binary};
    const std::string bytes{std::istreambuf_iterator<char>{in}, {}};
    EXPECT_THAT(bytes, Not(HasSubstr("WVWZZZ")));
}

TEST(RoadStore, AddsUpWhatItHolds) {
    auto store = new_store(test_folder() / "a.gpkg");
    EXPECT_EQ(store.info().km, 0);
    EXPECT_FALSE(is_empty(store.info().box));
    import_trips(store, 4);
    const auto info = store.info();
    EXPECT_EQ(info.trips, 4U);
    EXPECT_EQ(info.undated_trips, 1U);
    EXPECT_EQ(info.passes, 80U);
    EXPECT_THAT(info.vehicles, SizeIs(3));
    EXPECT_EQ(info.segments, records_of(store, all_segments()).size());
    EXPECT_EQ(info.segments_with_passes, 20U);
    EXPECT_NEAR(info.km, 0.4, 0.002);          // 200 m both ways
    EXPECT_NEAR(info.network_km, 0.64, 0.003); // and 40 m one way, 100 m both ways
    double km = 0;
    for (const auto& length : info.classes) {
        km += length.km;
    }
    EXPECT_NEAR(km, info.km, 1e-9);
    EXPECT_EQ(info.settings.attribution, testing::settings().attribution);
    EXPECT_EQ(info.first_seen_ms, trip_record(0).t0_utc_ms);
}

TEST(RoadStore, SaysWhatTheTripsOfEachCarGave) {
    auto store = new_store(test_folder() / "a.gpkg");
    EXPECT_THAT(store.usage().vehicles, IsEmpty());
    for (int number = 0; number < 4; ++number) { // trips 0 and 3 are of one car, 3 is undated
        auto trip = trip_record(number);
        trip.distance_mm = 1'500'000;
        trip.matched_mm = 1'200'000;
        trip.rows_read = 1000;
        trip.rows_used = 900;
        trip.method = number == 1 ? "other" : "kf";
        add_trip(store, trip, passes_of(number));
    }
    const auto uses = store.usage().vehicles;
    ASSERT_THAT(uses, SizeIs(3));
    const auto cars = store.usage().cars;
    EXPECT_TRUE(std::ranges::is_sorted(
        uses, {}, [&](const VehicleUse& use) { return std::ranges::find(cars, use.vehicle); }));
    const auto twice = std::ranges::find(uses, 2U, &VehicleUse::trips);
    ASSERT_NE(twice, uses.end());
    EXPECT_EQ(twice->method, "kf");
    EXPECT_EQ(twice->vehicle_model, "golden-car");
    EXPECT_EQ(twice->undated_trips, 1U);
    EXPECT_EQ(twice->passes, 40U);
    EXPECT_NEAR(twice->km, 3.0, 1e-9);
    EXPECT_NEAR(twice->matched_km, 2.4, 1e-9);
    EXPECT_EQ(twice->rows_read, 2000U);
    EXPECT_EQ(twice->rows_used, 1800U);
}

// ------------------------------------------------------------------------------------- filters

TEST(RoadStore, FindsSegmentsByWayKeyAndName) {
    auto store = new_store(test_folder() / "a.gpkg");
    auto filter = all_segments();
    filter.way_id = 2;
    EXPECT_THAT(keys_of(store, filter), ElementsAre("2+0000", "2+0001"));
    filter = all_segments();
    filter.key = SegmentKey{1, false, 9};
    EXPECT_THAT(keys_of(store, filter), ElementsAre("1-0009"));
    filter = all_segments();
    filter.name_part = "rUE DE";
    EXPECT_THAT(keys_of(store, filter), SizeIs(20));
}

TEST(RoadStore, TakesNothingInANameForAWildcard) {
    auto store = new_store(test_folder() / "a.gpkg");
    auto filter = all_segments();
    for (const auto* none : {"Rue%100", "_ue", "\\", "' OR 1 --"}) {
        filter.name_part = none;
        EXPECT_THAT(keys_of(store, filter), IsEmpty()) << none;
    }
    filter.name_part = "100%";
    EXPECT_THAT(keys_of(store, filter), SizeIs(20));
    filter.name_part = "_Lane_";
    EXPECT_THAT(keys_of(store, filter), SizeIs(2));
}

TEST(RoadStore, FindsWhatTheBoxTouches) {
    auto store = new_store(test_folder() / "a.gpkg");
    const auto all = records_of(store, all_segments());
    std::mt19937 random{5};
    const auto box = store.info().box;
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution{low, high}(random);
    };
    for (int round = 0; round < 30; ++round) {
        const double west = in(box.west_deg, box.east_deg),
                     south = in(box.south_deg, box.north_deg);
        const GeoBox window{west, south, west + 3e-4, south + 2e-4};
        std::vector<std::string> expected;
        for (const auto& record : all) {
            bool touches = false; // a walk along the line in steps of a few millimetres
            for (int step = 0; step <= 5000; ++step) {
                touches = touches || contains(window,
                                              between(record.segment.line.front(),
                                                      record.segment.line.back(),
                                                      step / 5000.0));
            }
            if (touches) {
                expected.push_back(name_of(record.segment.key));
            }
        }
        auto filter = all_segments();
        filter.box = window;
        EXPECT_EQ(keys_of(store, filter), expected);
    }
}

TEST(RoadStore, ShowsTheWorstFirst) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 2);
    auto records = records_of(store);
    std::stable_sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
        return a.state->iri_um > b.state->iri_um;
    });
    SegmentFilter filter;
    filter.worst = 4;
    const auto worst = records_of(store, filter);
    ASSERT_THAT(worst, SizeIs(4));
    for (std::size_t i = 0; i < worst.size(); ++i) {
        EXPECT_EQ(worst[i].segment.key, records[i].segment.key);
    }
}

// ------------------------------------------------------------------------------------ refusals

TEST(RoadStore, RefusesToReplaceAFile) {
    const auto file = testing::written(test_folder(), "a.gpkg", "mine");
    EXPECT_THAT(refusal_of([&] { new_store(file); }),
                HasSubstr("a.gpkg: already exists, expected the name of a new file"));
}

TEST(RoadStore, LeavesNothingBehindWhereItCannotBeMade) {
    const auto folder = test_folder();
    auto wrong = testing::settings();
    wrong.class_table = "nonsense";
    EXPECT_THAT(
        refusal_of([&] { RoadStore::create(folder / "a.gpkg", testing::small_country(), wrong); }),
        HasSubstr("class table 'nonsense', expected fhwa or five"));
    EXPECT_TRUE(std::filesystem::is_empty(folder));
    EXPECT_THAT(refusal_of([&] { new_store(folder / "missing" / "a.gpkg"); }),
                HasSubstr("a.gpkg: cannot be written: No such file or directory"));
}

TEST(RoadStore, RefusesWhatIsNoStore) {
    const auto folder = test_folder();
    const auto open = [](const std::filesystem::path& file) {
        return refusal_of([&] { StoreReader::open(file); });
    };
    EXPECT_THAT(open(folder / "none.gpkg"),
                HasSubstr("none.gpkg: no such file, expected a database made by 'macadam init'"));
    EXPECT_THAT(open(folder), HasSubstr("is not a file, expected a database"));
    for (const auto* content : {"", "# a text\n", "SQLite format 3"}) {
        EXPECT_THAT(open(testing::written(folder, "text.gpkg", content)),
                    AllOf(HasSubstr("text.gpkg: is "),
                          HasSubstr("not a Macadam database; expected one made by "
                                    "'macadam init'")));
    }
}

TEST(RoadStore, RefusesPassesOverRoadsItDoesNotHave) {
    auto store = new_store(test_folder() / "a.gpkg");
    const auto before = store.digest();
    auto passes = passes_of(0);
    passes.back().segment = {2, false, 0}; // against the oneway
    EXPECT_THAT(refusal_of([&] { add_trip(store, trip_record(0), passes); }),
                HasSubstr("a.gpkg: has no segment '2-0000', expected passes over its own network"));
    EXPECT_EQ(store.digest(), before);
    EXPECT_FALSE(store.contains_trip(trip_record(0).sha256));
}

} // namespace
} // namespace macadam
