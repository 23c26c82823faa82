// What a store answers, against all that it holds.

#include "mapping/style/iri_class.hpp"
#include "storage/store/road_store.hpp"
#include "storage/text/case_folding.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace macadam {
namespace {

using testing::add_trip;
using ::testing::ElementsAre;
using testing::import_trips;
using ::testing::IsEmpty;
using testing::new_store;
using ::testing::Not;
using testing::passes_of;
using ::testing::SizeIs;
using testing::test_folder;
using testing::trip_record;

std::vector<SegmentRecord> records_of(const StoreReader& store, const SegmentFilter& filter = {}) {
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

std::vector<std::string> keys_of(const std::vector<SegmentRecord>& records) {
    std::vector<std::string> keys;
    for (const auto& record : records) {
        keys.push_back(name_of(record.segment.key));
    }
    return keys;
}

/// Of everything in the store, what a condition leaves.
std::vector<std::string> keys_where(const StoreReader& store,
                                    const std::function<bool(const SegmentRecord&)>& holds) {
    SegmentFilter everything;
    everything.with_state_only = false;
    auto records = records_of(store, everything);
    std::erase_if(records, [&](const auto& record) { return !holds(record); });
    return keys_of(records);
}

TEST(StoreQuery, FindsNamesInAnyCaseWithAccents) {
    const auto store = new_store(test_folder() / "a.gpkg");
    const auto named = [&](const std::string& part) {
        SegmentFilter filter;
        filter.name_part = part;
        filter.with_state_only = false;
        return keys_of(records_of(store, filter));
    };
    const auto sword_street =
        keys_where(store, [](const auto& record) { return record.segment.key.way_id == 1; });
    ASSERT_THAT(sword_street, Not(IsEmpty()));
    EXPECT_EQ(named("L'ÉPÉE"), sword_street);
    EXPECT_EQ(named("épée 100%"), sword_street);
    EXPECT_THAT(named("epee"), IsEmpty());
    EXPECT_EQ(named("_lane_"),
              keys_where(store, [](auto& record) { return record.segment.key.way_id == 2; }));
    EXPECT_THAT(named("x_lane"), IsEmpty()); // no wildcard
}

TEST(StoreQuery, ShowsAtAGlanceWhatAVisitTells) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 3);
    store.importer.refresh();
    SegmentFilter everything;
    everything.with_state_only = false;
    SegmentFilter worst;
    worst.worst = 3;
    SegmentFilter of_a_time;
    of_a_time.period = Period{.from_ms = 0, .until_ms = {}};
    for (const auto& filter : {SegmentFilter{}, everything, worst, of_a_time}) {
        const auto records = records_of(store, filter);
        ASSERT_THAT(records, Not(IsEmpty()));
        std::size_t seen = 0;
        store.visit_summaries(filter, [&](const SegmentSummary& visit_summaries) {
            ASSERT_LT(seen, records.size());
            const auto& [segment, name, highway, state] = records[seen++];
            EXPECT_EQ(visit_summaries.key, segment.key);
            EXPECT_TRUE(std::ranges::equal(visit_summaries.line, segment.line));
            EXPECT_EQ(visit_summaries.name, name);
            EXPECT_EQ(visit_summaries.highway, highway);
            ASSERT_EQ(visit_summaries.roughness.has_value(), state.has_value());
            if (state) {
                EXPECT_EQ(visit_summaries.roughness->iri_um, state->iri_um);
                EXPECT_EQ(visit_summaries.roughness->sd_um, state->sd_um);
                EXPECT_EQ(visit_summaries.roughness->passes, state->passes);
            }
        });
        EXPECT_EQ(seen, records.size());
    }
}

TEST(StoreQuery, TellsForTilesWhatTheyShow) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 3);
    store.importer.refresh();
    SegmentFilter everything;
    everything.with_state_only = false;
    auto records = records_of(store, everything);
    std::size_t seen = 0;
    store.visit(
        everything,
        [&](const SegmentRecord& shown) {
            ASSERT_LT(seen, records.size());
            auto& [segment, name, highway, state] = records[seen++];
            EXPECT_EQ(shown.segment.key, segment.key);
            EXPECT_EQ(shown.segment.from_m, segment.from_m);
            EXPECT_EQ(shown.segment.to_m, segment.to_m);
            EXPECT_EQ(shown.segment.line, segment.line);
            EXPECT_EQ(shown.name, name);
            EXPECT_EQ(shown.highway, highway);
            if (state) {
                state->left_um = state->right_um = state->trend_sd_um_per_year = std::nullopt;
                state->centre_only = false;
                state->change = std::nullopt;
            }
            EXPECT_EQ(shown.state, state);
        },
        StateDetail::tiles);
    EXPECT_EQ(seen, records.size());
}

TEST(StoreQuery, AnswersWhileItIsStillTelling) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 2);
    store.importer.refresh();
    SegmentFilter everywhere;
    everywhere.box = GeoBox{-180, -90, 180, 90};
    const auto keys = keys_of(records_of(store, everywhere));
    std::vector<std::string> outer;
    store.visit(everywhere, [&](const SegmentRecord& record) {
        EXPECT_EQ(keys_of(records_of(store, everywhere)), keys);
        outer.push_back(name_of(record.segment.key));
    });
    EXPECT_EQ(outer, keys);
}

TEST(StoreQuery, AnswersAnewAfterItWasInterrupted) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 2);
    store.importer.refresh();
    SegmentFilter everywhere;
    everywhere.box = GeoBox{-180, -90, 180, 90};
    const auto before = keys_of(records_of(store, everywhere));
    ASSERT_GT(before.size(), 1U);
    const auto interrupt = [](const SegmentRecord&) { throw std::runtime_error{"enough"}; };
    EXPECT_THROW(store.visit(everywhere, interrupt), std::runtime_error);
    import_trips(store, 3); // a reading that went on would be of the moment before
    store.importer.refresh();
    EXPECT_EQ(keys_of(records_of(store, everywhere)),
              keys_where(store, [](const auto& record) { return record.state.has_value(); }));
}

TEST(StoreQuery, AddsUpConditions) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 3);
    const auto trip = passes_of(3);
    add_trip(store, trip_record(3), std::span{trip}.subspan(2, 1));
    store.importer.refresh();
    const auto& classes = *class_table("fhwa");
    const auto class_of = [&](const SegmentRecord& record) {
        return record.state
                   ? classes.classes[class_index(classes, record.state->iri_um / 1000.0)].name
                   : std::string_view{};
    };
    for (const std::string class_name : {"", "good", "fair", "poor"}) {
        for (const std::string highway : {"", "residential", "service"}) {
            for (const int min_passes : {0, 1, 3, 4}) {
                for (const bool driven : {true, false}) {
                    SegmentFilter filter;
                    filter.class_name = class_name;
                    filter.highway = highway;
                    filter.min_passes = min_passes;
                    filter.with_state_only = driven;
                    const auto expected = keys_where(store, [&](const SegmentRecord& record) {
                        return (!driven || record.state) &&
                               (class_name.empty() || class_of(record) == class_name) &&
                               (highway.empty() || record.highway == highway) &&
                               (record.state ? record.state->passes : 0) >= min_passes;
                    });
                    EXPECT_EQ(keys_of(records_of(store, filter)), expected);
                    filter.name_part = "RUE";
                    filter.way_id = 1;
                    auto on_street = expected;
                    std::erase_if(on_street, [](auto& key) { return !key.starts_with("1"); });
                    EXPECT_EQ(keys_of(records_of(store, filter)), on_street);
                }
            }
        }
    }
}

TEST(StoreQuery, GivesRangesInTheirOrder) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 1);
    SegmentFilter filter;
    filter.ranges = {{1, false, 3, 5}, {1, true, 0, 2}, {7, true, 0, 9}, {1, true, 9, 9}};
    EXPECT_THAT(keys_of(records_of(store, filter)),
                ElementsAre("1-0003", "1-0004", "1+0000", "1+0001"));
    filter.ranges = std::vector<SegmentRange>{};
    EXPECT_THAT(records_of(store, filter), IsEmpty());
}

TEST(StoreQuery, KeepsOnlyTheWorstWhateverTheConditions) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 2);
    for (const std::size_t n : {1U, 3U, 100U}) {
        SegmentFilter filter;
        filter.name_part = "rue";
        auto all = records_of(store, filter);
        std::ranges::stable_sort(
            all, std::greater{}, [](const auto& record) { return record.state->iri_um; });
        all.resize(std::min(n, all.size()));
        filter.worst = n;
        EXPECT_EQ(keys_of(records_of(store, filter)), keys_of(all));
    }
}

// -------------------------------------------------------------------------------------- periods

constexpr std::int64_t day_ms = 86'400'000;

/// When a trip of the world began; every fourth has no date.
std::int64_t begin_ms(int number) {
    return *trip_record(number).t0_utc_ms;
}

TEST(StoreQuery, TellsOfAPeriodWhatAStoreOfItsTripsTells) {
    const auto folder = test_folder();
    auto all = new_store(folder / "all.gpkg");
    import_trips(all, 10);
    auto some = new_store(folder / "some.gpkg");
    for (const int number : {4, 5, 6}) { // the seventh is undated
        add_trip(some, trip_record(number), passes_of(number));
    }
    some.importer.refresh();

    SegmentFilter filter;
    filter.period = Period{begin_ms(4), begin_ms(8)};
    const auto of_period = records_of(all, filter);
    const auto expected = records_of(some);
    ASSERT_THAT(of_period, SizeIs(20));
    ASSERT_THAT(expected, SizeIs(20));
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(of_period[i].state, expected[i].state);
    }
}

TEST(StoreQuery, CountsAPassAtTheBeginningOfAPeriodAndNotAtItsEnd) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 3);
    const auto at_ms = begin_ms(1) + passes_of(1).front().t_ms;
    const auto passes = [&](const Period& period) {
        SegmentFilter filter;
        filter.key = SegmentKey{1, true, 0};
        filter.period = period;
        const auto found = records_of(store, filter);
        return found.empty() ? 0 : found.front().state->passes;
    };
    EXPECT_EQ(passes({at_ms, at_ms + 1}), 1);
    EXPECT_EQ(passes({at_ms + 1, at_ms + day_ms}), 0);
    EXPECT_EQ(passes({at_ms - day_ms, at_ms}), 0);
    EXPECT_EQ(passes({at_ms, std::nullopt}), 2);
    EXPECT_EQ(passes({std::nullopt, at_ms + 1}), 2);
}

TEST(StoreQuery, ShowsSegmentsWithoutAPassInThePeriodOnlyIfAsked) {
    auto store = new_store(test_folder() / "a.gpkg");
    import_trips(store, 1);
    SegmentFilter filter;
    filter.way_id = 1;
    filter.period = Period{begin_ms(0) + day_ms, std::nullopt};
    EXPECT_THAT(records_of(store, filter), IsEmpty());
    filter.with_state_only = false;
    const auto records = records_of(store, filter);
    EXPECT_THAT(records, SizeIs(20));
    for (const auto& record : records) {
        EXPECT_FALSE(record.state);
    }
}

// ------------------------------------------------------------------------------- what it costs

/// Rows that SQLite stepped through for want of an index, in all statements that end within.
class FullScanCounter {
public:
    FullScanCounter() {
        count_ = 0;
        sqlite3_auto_extension(reinterpret_cast<void (*)()>(watch));
    }
    FullScanCounter(const FullScanCounter&) = delete;
    FullScanCounter& operator=(const FullScanCounter&) = delete;
    ~FullScanCounter() { sqlite3_reset_auto_extension(); }

    template <typename Work>
    int during(Work work) {
        count_ = 0;
        work();
        return count_;
    }

private:
    static int watch(sqlite3* database, const char** /*error*/, const void* /*api*/) {
        sqlite3_trace_v2(database, SQLITE_TRACE_PROFILE, add, nullptr);
        return SQLITE_OK;
    }
    static int add(unsigned /*event*/, void* /*context*/, void* statement, void* /*time*/) {
        count_ += sqlite3_stmt_status(
            static_cast<sqlite3_stmt*>(statement), SQLITE_STMTSTATUS_FULLSCAN_STEP, 1);
        return 0;
    }
    static inline int count_ = 0;
};

TEST(StoreQuery, FindsRowsByIndexAlone) {
    const auto file = test_folder() / "a.gpkg";
    {
        auto store = new_store(file);
        import_trips(store, 3);
    }
    FullScanCounter scans;
    const auto store = StoreReader::open(file);
    const auto scanned = [&](const SegmentFilter& filter) {
        return scans.during([&] { records_of(store, filter); });
    };
    EXPECT_GT(scanned({}), 10); // the counter counts: this asks for everything

    SegmentFilter by_key, by_way, by_range, by_box;
    by_key.key = SegmentKey{1, true, 3};
    by_way.way_id = 1;
    by_range.ranges = {{1, true, 2, 5}};
    by_box.box = GeoBox{4, 45, 5, 46};
    for (auto* const filter : {&by_key, &by_way, &by_range, &by_box}) {
        for (const bool driven : {true, false}) {
            for (const bool of_a_period : {true, false}) {
                filter->with_state_only = driven;
                filter->period =
                    of_a_period ? std::optional{Period{0, std::nullopt}} : std::nullopt;
                EXPECT_EQ(scanned(*filter), 0);
            }
        }
    }
    SegmentFilter by_name; // looks through the names, not through the segments
    by_name.name_part = "rue";
    EXPECT_LE(scanned(by_name), 2);
    EXPECT_EQ(scans.during([&] { store.history({1, true, 3}); }), 0);
}

} // namespace
} // namespace macadam
