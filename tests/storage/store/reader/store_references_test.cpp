// References and control sections in a store.

#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

namespace {

constexpr std::int64_t day_ms = 86'400'000;
constexpr std::int64_t survey_ms = 1'770'000'000'000;

TripRecord survey_record(const std::string& name) {
    TripRecord survey;
    survey.sha256 = std::string(64, name.back());
    survey.trip_id = name;
    survey.file_name = name + ".csv";
    survey.t0_utc_ms = survey_ms;
    survey.method = "reference";
    survey.rows_read = 12;
    survey.rows_used = 10;
    survey.row_reasons = {{"no_place", 2}};
    survey.reference = ReferenceNote{30'000, 20'000};
    return survey;
}

/// 2 mm/m on the first five segments of way 1 and on one of way 3 where no trip has been.
std::vector<Pass> survey_passes() {
    std::vector<Pass> passes;
    for (std::uint32_t index = 0; index < 5; ++index) {
        Pass pass{};
        pass.segment = {1, true, index};
        pass.iri_um = 2000;
        pass.sd_um = 60;
        pass.covered_mm = 20'000;
        pass.confidence_ppm = 1'000'000;
        passes.push_back(pass);
    }
    passes.push_back(passes.front());
    passes.back().segment = {3, true, 0};
    return passes;
}

std::vector<SegmentRecord> states_of(const StoreReader& store, const SegmentFilter& filter = {}) {
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

bool same_states(const std::vector<SegmentRecord>& a, const std::vector<SegmentRecord>& b) {
    return std::ranges::equal(a, b, {}, &SegmentRecord::state, &SegmentRecord::state);
}

} // namespace

TEST(ReferenceStore, KeepsSurveysApartFromTripsAndCars) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 4);
    const auto before = store.info();
    ASSERT_TRUE(add_trip(store, survey_record("survey-a"), survey_passes()));
    store.importer.refresh();

    const auto info = store.info();
    EXPECT_EQ(info.trips, before.trips);
    EXPECT_EQ(info.undated_trips, before.undated_trips);
    EXPECT_EQ(info.passes, before.passes);
    EXPECT_EQ(info.vehicles, before.vehicles);
    EXPECT_EQ(info.segments_with_passes, before.segments_with_passes + 1);
    EXPECT_THAT(store.usage().row_reasons, IsEmpty());
    EXPECT_THAT(store.usage().days, SizeIs(3)); // of the dated trips

    const auto surveys = store.surveys();
    ASSERT_THAT(surveys, SizeIs(1));
    EXPECT_EQ(surveys[0].name, "survey-a");
    EXPECT_EQ(surveys[0].utc_ms, survey_ms);
    EXPECT_NEAR(surveys[0].relative_sd, 0.03, 1e-12);
    EXPECT_EQ(surveys[0].passes, 6U);
    EXPECT_EQ(surveys[0].rows_used, 10U);
    EXPECT_GT(surveys[0].km, 5.5 * surveys[0].alone_km); // one segment of six about as long
    EXPECT_GT(surveys[0].alone_km, 0.01);
}

TEST(ReferenceStore, CountsSegmentsOfReferencesAloneAsZeroPasses) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 4);
    add_trip(store, survey_record("survey-a"), survey_passes());
    store.importer.refresh();
    SegmentFilter alone;
    alone.key = SegmentKey{3, true, 0};
    const auto records = states_of(store, alone);
    ASSERT_THAT(records, SizeIs(1));
    EXPECT_EQ(records[0].state->iri_um, 2000);
    EXPECT_EQ(records[0].state->sd_um, 60);
    EXPECT_EQ(records[0].state->passes, 0);
    EXPECT_EQ(records[0].state->vehicles, 0);
    alone.min_passes = 1;
    EXPECT_THAT(states_of(store, alone), IsEmpty());
}

TEST(ReferenceStore, TellsWhatTheCarsAloneSay) {
    const auto folder = test_folder();
    auto with = new_store(folder / "with.gpkg");
    auto without = new_store(folder / "without.gpkg");
    import_trips(with, 5);
    import_trips(without, 5);
    add_trip(with, survey_record("survey-a"), survey_passes());
    with.importer.refresh();
    SegmentFilter cars;
    cars.cars_alone = true;
    EXPECT_TRUE(same_states(states_of(with, cars), states_of(without)));
    EXPECT_FALSE(same_states(states_of(with), states_of(without)));

    SegmentFilter after;
    after.period = Period{survey_ms, survey_ms + day_ms};
    EXPECT_THAT(states_of(with, after), SizeIs(6)); // its own day: the reference alone
    after.cars_alone = true;
    EXPECT_THAT(states_of(with, after), IsEmpty());
}

TEST(ReferenceStore, MovesTheNumberTowardsTheSurvey) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 5);
    SegmentFilter first;
    first.key = SegmentKey{1, true, 0};
    const auto before = *states_of(store, first)[0].state;
    add_trip(store, survey_record("survey-a"), survey_passes());
    store.importer.refresh();
    const auto after = *states_of(store, first)[0].state;
    EXPECT_LT(std::abs(after.iri_um - 2000), std::abs(before.iri_um - 2000));
    EXPECT_LT(after.sd_um, before.sd_um);
    EXPECT_EQ(after.passes, before.passes);
}

TEST(ReferenceStore, HasOneDigestWhateverTheOrder) {
    std::vector<int> order{0, 1, 2, 3, 4, 5}; // 4 and 5 are surveys
    std::mt19937 random{5};
    std::string digest;
    for (int round = 0; round < 4; ++round) {
        auto store = new_store(test_folder() / "roads.gpkg");
        for (const int number : order) {
            if (number < 4) {
                add_trip(store, trip_record(number), passes_of(number));
            } else {
                add_trip(
                    store, survey_record(number == 4 ? "survey-a" : "survey-b"), survey_passes());
            }
            if (random() % 2 == 0) {
                store.importer.refresh();
            }
        }
        store.importer.refresh();
        if (round > 0) {
            EXPECT_EQ(store.digest(), digest);
        }
        digest = store.digest();
        std::ranges::shuffle(order, random);
    }
    auto cars = new_store(test_folder() / "roads.gpkg");
    import_trips(cars, 4);
    EXPECT_NE(cars.digest(), digest);
}

TEST(ReferenceStore, KnowsASurveyByItsContent) {
    auto store = new_store(test_folder() / "roads.gpkg");
    EXPECT_TRUE(add_trip(store, survey_record("survey-a"), survey_passes()));
    store.importer.refresh();
    const auto digest = store.digest();
    EXPECT_FALSE(add_trip(store, survey_record("survey-a"), survey_passes()));
    EXPECT_EQ(store.digest(), digest);
}

TEST(ReferenceStore, ForgetsASurveyAsIfItHadNeverBeenThere) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 4);
    const auto digest = store.digest();
    add_trip(store, survey_record("survey-a"), survey_passes());
    store.importer.refresh();
    store.maintenance.forget({.trips = {"survey-a"}, .vehicles = {}});
    EXPECT_EQ(store.digest(), digest);
    EXPECT_THAT(store.surveys(), IsEmpty());
}

TEST(ReferenceStore, ForgetsCarsBesideASurvey) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 4); // of three cars
    add_trip(store, survey_record("survey-a"), survey_passes());
    store.importer.refresh();
    store.maintenance.forget({.trips = {}, .vehicles = {"car-1"}});
    EXPECT_THAT(store.info().vehicles, SizeIs(2));
    EXPECT_THAT(store.surveys(), SizeIs(1));
}

TEST(ReferenceStore, NamesTheSurveyAmongThePasses) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 2);
    add_trip(store, survey_record("survey-a"), survey_passes());
    store.importer.refresh();
    const auto passes = store.history({1, true, 0});
    ASSERT_THAT(passes, SizeIs(3));
    EXPECT_EQ(std::ranges::count(
                  passes, std::optional<std::string>{"survey-a"}, &HistoricPass::reference),
              1);
    const auto survey = std::ranges::find_if(
        passes, [](const HistoricPass& pass) { return pass.reference.has_value(); });
    EXPECT_EQ(survey->vehicle, "");
    EXPECT_EQ(survey->utc_ms, survey_ms);
    EXPECT_EQ(survey->lag_m, std::nullopt); // it is never moved
}

TEST(ReferenceStore, ReadsItsReferencesInTheOrderOfSegments) {
    auto store = new_store(test_folder() / "roads.gpkg");
    add_trip(store, survey_record("survey-b"), survey_passes());
    add_trip(store, survey_record("survey-a"), survey_passes());
    const auto readings = store.reference_readings();
    ASSERT_THAT(readings, SizeIs(12));
    EXPECT_EQ(readings[0].segment.key, (SegmentKey{1, true, 0}));
    EXPECT_EQ(readings[0].survey, 0U);
    EXPECT_EQ(readings[1].segment.key, (SegmentKey{1, true, 0}));
    EXPECT_EQ(readings[1].survey, 1U);
    EXPECT_EQ(readings[11].segment.key, (SegmentKey{3, true, 0}));
    EXPECT_EQ(store.surveys()[0].name, "survey-a");
}

TEST(ControlSections, AreKeptByNameAndReplaced) {
    auto store = new_store(test_folder() / "roads.gpkg");
    const ControlSection south{"south", 1, true, 20, 120.5, 1.5, 0.05, survey_ms};
    const ControlSection north{"north", 1, false, 0, 60, 2.5, 0.1, std::nullopt};
    store.maintenance.put_control_sections(std::vector{south, north});
    EXPECT_THAT(store.control_sections(), ElementsAre(north, south));
    auto moved = south;
    moved.iri_mm_per_m = 1.8;
    store.maintenance.put_control_sections({&moved, 1});
    EXPECT_THAT(store.control_sections(), ElementsAre(north, moved));
}

TEST(ControlSections, DoNotEnterTheNumbers) {
    auto store = new_store(test_folder() / "roads.gpkg");
    import_trips(store, 3);
    const auto digest = store.digest();
    const ControlSection south{"south", 1, true, 20, 120, 9, 0.05, survey_ms};
    store.maintenance.put_control_sections({&south, 1});
    store.importer.refresh();
    EXPECT_EQ(store.digest(), digest);
}
