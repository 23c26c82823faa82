// What is done to a store beside bringing trips in: calibrate, reprocess, forget, valid from.

#include "estimator/common/error.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/fleet_passes.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace macadam::testing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

void add(RoadStore& store, int number) {
    add_trip(store, trip_record(number), passes_of(number));
}

/// A store of these trips and no others, fused.
RoadStore store_of(const std::filesystem::path& file, const std::vector<int>& trips) {
    auto store = new_store(file);
    for (const int number : trips) {
        add(store, number);
    }
    store.importer.refresh();
    return store;
}

std::vector<int> up_to(int count) {
    std::vector<int> numbers;
    for (int i = 0; i < count; ++i) {
        numbers.push_back(i);
    }
    return numbers;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

// ---------------------------------------------------------------------------------------- forget

TEST(Forget, LeavesWhatAStoreHoldsThatNeverSawTheTrips) {
    const auto folder = test_folder();
    auto store = store_of(folder / "a.gpkg", up_to(9));
    const auto forgotten =
        store.maintenance.forget({.trips = {"trip-2", "trip7.trip.csv"}, .vehicles = {}});
    EXPECT_EQ(forgotten.trips, 2U);
    EXPECT_EQ(forgotten.passes, 40U);
    EXPECT_EQ(forgotten.segments, 20U);
    EXPECT_FALSE(forgotten.calibrated);
    EXPECT_TRUE(forgotten.log_is_clean);
    EXPECT_EQ(store.digest(), store_of(folder / "b.gpkg", {0, 1, 3, 4, 5, 6, 8}).digest());
}

TEST(Forget, KnowsACarByItsIdOrByItsPseudonym) {
    const auto folder = test_folder();
    const auto without = store_of(folder / "without.gpkg", {0, 2, 3, 5}).digest();
    auto by_id = store_of(folder / "id.gpkg", up_to(6));
    EXPECT_EQ(by_id.maintenance.forget({.trips = {}, .vehicles = {"car-1"}}).trips, 2U);
    EXPECT_EQ(by_id.digest(), without);
    EXPECT_THAT(by_id.info().vehicles, SizeIs(2));

    auto by_pseudonym = store_of(folder / "pseudonym.gpkg", up_to(6));
    const auto pseudonym = by_pseudonym.history({1, true, 0})[0].vehicle;
    by_pseudonym.maintenance.forget({.trips = {}, .vehicles = {pseudonym}});
    EXPECT_THAT(by_pseudonym.history({1, true, 0}),
                Each(Field(&HistoricPass::vehicle, Not(pseudonym))));
}

TEST(Forget, LeavesSegmentsWithoutAPassWithoutANumber) {
    auto store = store_of(test_folder() / "a.gpkg", {1});
    store.maintenance.forget({.trips = {"trip-1"}, .vehicles = {}});
    EXPECT_EQ(store.info().segments_with_passes, 0U);
    EXPECT_EQ(store.digest(), new_store(test_folder() / "b.gpkg").digest());
}

TEST(Forget, LeavesNoByteOfATripInTheFile) {
    const auto file = test_folder() / "a.gpkg";
    const auto trip = trip_record(4);
    {
        auto store = store_of(file, up_to(6));
        EXPECT_THAT(bytes_of(file) + bytes_of(file.string() + "-wal"), HasSubstr(trip.sha256));
        store.maintenance.forget({.trips = {trip.sha256}, .vehicles = {}});
    }
    const auto bytes = bytes_of(file);
    EXPECT_FALSE(std::filesystem::exists(file.string() + "-wal"));
    for (const auto& word : {trip.sha256, trip.trip_id, trip.file_name}) {
        EXPECT_EQ(bytes.find(word), std::string::npos) << word;
    }
    EXPECT_NE(bytes.find(trip_record(3).sha256), std::string::npos);
}

TEST(Forget, SaysThatTheLogHoldsBytesWhileSomebodyReads) {
    const auto file = test_folder() / "a.gpkg";
    auto store = store_of(file, up_to(3));
    const auto reader = StoreReader::open(file);
    bool is_clean = true;
    reader.visit({}, [&](const SegmentRecord& record) {
        if (record.segment.key == SegmentKey{1, true, 0}) {
            is_clean = store.maintenance.forget({.trips = {"trip-0"}, .vehicles = {}}).log_is_clean;
        }
    });
    EXPECT_FALSE(is_clean);
}

TEST(Forget, RefusesWhatItDoesNotKnowAndForgetsNothing) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(3));
    const auto before = store.digest();
    EXPECT_THAT(
        refusal_of([&] {
            store.maintenance.forget({.trips = {"trip-0", "trip-9"}, .vehicles = {}});
        }),
        HasSubstr("a.gpkg: has no trip 'trip-9', expected a trip_id, the name of its file or the "
                  "64 hex digits of its SHA-256"));
    EXPECT_THAT(refusal_of([&] { store.maintenance.forget({.trips = {}, .vehicles = {"car-7"}}); }),
                HasSubstr("a.gpkg: has no trip of vehicle 'car-7', expected a vehicle_id or a "
                          "pseudonym as listed by 'macadam info'"));
    EXPECT_EQ(store.digest(), before);
}

TEST(Forget, KeepsATripOutUntilItIsTakenBack) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(4));
    const auto before = store.digest();
    store.maintenance.forget({.trips = {"trip-3"}, .vehicles = {}});
    const auto trip = trip_record(3);
    const auto passes = passes_of(3);
    EXPECT_TRUE(store.has_forgotten(trip.sha256));
    EXPECT_FALSE(store.has_forgotten(trip_record(2).sha256));
    EXPECT_FALSE(add_trip(store, trip, passes));
    const NewTrip taken_back{&trip, passes, {}, true};
    EXPECT_THAT(store.importer.add_trips({&taken_back, 1}), ElementsAre(true));
    store.importer.refresh();
    EXPECT_EQ(store.digest(), before);
}

TEST(Forget, IsUndoneWhenItIsCutOff) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(4));
    const auto before = store.digest();
    std::stop_source source;
    source.request_stop();
    EXPECT_THAT(refusal_of([&] {
                    store.maintenance.forget({.trips = {"trip-1"}, .vehicles = {}},
                                             {.report = {}, .stop = source.get_token()});
                }),
                HasSubstr("a.gpkg: interrupted; the database is unchanged"));
    EXPECT_EQ(store.digest(), before);
    EXPECT_EQ(store.waiting(), 0U);
}

// ------------------------------------------------------------------------------------- valid from

TEST(ValidFrom, LeavesOlderAndUndatedPassesOutUntilTheyCountAgain) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(8)); // 3 and 7 are undated
    const auto before = store.digest();
    const std::vector<SegmentKey> segments{{1, true, 2}, {1, false, 2}};
    const auto from_ms = *trip_record(5).t0_utc_ms;
    EXPECT_EQ(store.maintenance.set_valid_from(segments, from_ms, "resurfaced"), 2U);
    store.visit({}, [&](const SegmentRecord& record) {
        EXPECT_EQ(record.state->passes, record.segment.key.index == 2 ? 2 : 8);
    });
    ASSERT_THAT(store.valid_since(), SizeIs(2));
    EXPECT_EQ(store.valid_since()[0].segment, segments[0]);
    EXPECT_EQ(store.valid_since()[0].from_ms, from_ms);

    store.maintenance.set_valid_from(segments, std::nullopt, "");
    EXPECT_THAT(store.valid_since(), IsEmpty());
    EXPECT_EQ(store.digest(), before);
}

TEST(ValidFrom, HoldsForPassesThatComeLater) {
    const auto folder = test_folder();
    const std::vector<SegmentKey> segments{{1, true, 4}};
    const auto from_ms = *trip_record(2).t0_utc_ms;
    auto first = new_store(folder / "first.gpkg");
    first.maintenance.set_valid_from(segments, from_ms, "");
    for (const int number : up_to(4)) {
        add(first, number);
    }
    first.importer.refresh();
    auto last = store_of(folder / "last.gpkg", up_to(4));
    last.maintenance.set_valid_from(segments, from_ms, "");
    EXPECT_EQ(first.digest(), last.digest());
}

TEST(ValidFrom, LeavesASegmentWithoutANumberWhereNoPassIsThatNew) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(3));
    store.maintenance.set_valid_from(std::vector<SegmentKey>{{1, true, 0}}, 4'000'000'000'000, "");
    EXPECT_EQ(store.info().segments_with_passes, 19U);
    EXPECT_THAT(store.history({1, true, 0}), SizeIs(3)); // they are still there
    EXPECT_EQ(store.changes({1, true, 0}).back().iri_um, std::nullopt);
}

// ------------------------------------------------------------------------------------------ audit

TEST(Audit, TellsWhenAndWhyANumberChanged) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(3));
    add(store, 4);
    store.importer.refresh();
    const std::vector<SegmentKey> segments{{1, true, 5}};
    store.maintenance.set_valid_from(segments, *trip_record(4).t0_utc_ms, "resurfaced");
    const auto entries = store.audit();
    ASSERT_THAT(entries, SizeIs(3));
    EXPECT_EQ(entries[0].what, "import");
    EXPECT_EQ(entries[0].segments, 20U);
    EXPECT_EQ(entries[2].what, "valid-from");
    EXPECT_EQ(entries[2].detail, "1 segments from 2026-11-13T08:53:20.123Z: resurfaced");
    EXPECT_EQ(entries[2].segments, 1U);

    const auto changes = store.changes(segments[0]);
    ASSERT_THAT(changes, SizeIs(3));
    EXPECT_EQ(changes[0].passes, 3);
    EXPECT_EQ(changes[1].passes, 4);
    EXPECT_EQ(changes[2].passes, 1);
    EXPECT_EQ(changes[2].iri_um, passes_of(4)[5].iri_um); // a single pass is what it says
    EXPECT_THAT(store.changes({1, true, 6}), SizeIs(2));
}

TEST(Audit, NotesNothingWhereNothingChanged) {
    auto store = store_of(test_folder() / "a.gpkg", up_to(3));
    store.importer.refresh();
    EXPECT_THAT(store.audit(), SizeIs(1));
}

TEST(Audit, ForgetsWhatForgottenTripsDidToANumber) {
    auto store = store_of(test_folder() / "a.gpkg", {0});
    add(store, 1);
    store.importer.refresh();
    store.maintenance.forget({.trips = {"trip-1"}, .vehicles = {}});
    const auto changes = store.changes({1, true, 0});
    ASSERT_THAT(changes, SizeIs(1));
    EXPECT_EQ(changes[0].cause.what, "forget");
    EXPECT_EQ(changes[0].passes, 1);
}

// -------------------------------------------------------------------------------------- calibrate

RoadStore fleet_store(const std::filesystem::path& file, const std::vector<int>& trips) {
    auto store = new_store(file);
    for (const int number : trips) {
        add_trip(store, trip_record(number), passes_of_fleet(number));
    }
    store.importer.refresh();
    return store;
}

TripRecord trip_by(const char* method, int number) {
    auto trip = trip_record(number);
    trip.method = method;
    return trip;
}

/// Passes that state 40 %.
std::vector<Pass> unsure_passes(int number) {
    auto passes = passes_of_fleet(number);
    for (auto& pass : passes) {
        pass.sd_um = pass.iri_um * 4 / 10;
    }
    return passes;
}

RoadStore unsure_store(const std::filesystem::path& file, const char* method) {
    auto store = new_store(file);
    for (const int number : up_to(6)) {
        add_trip(store, trip_by(method, number), unsure_passes(number));
    }
    store.importer.refresh();
    return store;
}

TEST(FusedChunks, LimitWhatUnknownCarsShareUnlessTheFilterReadIt) {
    const auto sds_by = [](const char* method) {
        const auto store = unsure_store(test_folder() / (std::string{method} + ".gpkg"), method);
        std::vector<double> sds;
        store.visit({}, [&](const SegmentRecord& record) {
            if (record.state && record.state->vehicles > 1) {
                sds.push_back(double(record.state->sd_um) / record.state->iri_um);
            }
        });
        return sds;
    };
    const auto smoothed = sds_by("smoother"), filtered = sds_by("kf");
    ASSERT_EQ(smoothed.size(), filtered.size());
    ASSERT_FALSE(smoothed.empty());
    for (std::size_t i = 0; i < smoothed.size(); ++i) {
        EXPECT_GT(filtered[i], 0.28) << i; // half of (40 %)^2
        EXPECT_LT(smoothed[i], filtered[i]) << i;
    }
}

std::vector<int> without(std::vector<int> numbers, int number) {
    std::erase(numbers, number);
    return numbers;
}

TEST(Calibrate, FindsTheCarThatReadsTooHighAndFusesByIt) {
    auto store = fleet_store(test_folder() / "a.gpkg", up_to(24));
    const auto report = store.maintenance.calibrate();
    EXPECT_EQ(report.generation, 2);
    EXPECT_EQ(store.info().generation, 2);
    const auto cars = store.usage().calibrated_cars;
    EXPECT_GT(report.left_out_readings, 0U);
    EXPECT_LE(report.left_out_readings, report.readings);
    EXPECT_LE(report.left_out_held, report.left_out_readings);
    ASSERT_THAT(cars, SizeIs(3));
    std::vector<double> at_2000;
    for (const auto& car : cars) {
        at_2000.push_back(car.calibration->gain + car.calibration->offset_um / 2000);
        EXPECT_EQ(car.trips, 8U);
    }
    std::ranges::sort(at_2000);
    EXPECT_NEAR(at_2000[2] / at_2000[0], 1.25, 0.02);
    EXPECT_NEAR(at_2000[1] / at_2000[0], 1, 0.02);
    EXPECT_EQ(store.audit().back().what, "calibrate");
    // The mean of three cars is taken to be right, the one that is off weighed less.
    store.visit({}, [&](const SegmentRecord& record) {
        const double truth_um = 1000 + 300 * double(record.segment.key.index);
        EXPECT_NEAR(record.state->iri_um / truth_um, 1.05, 0.05);
    });
}

TEST(Calibrate, TakesWhatASurveySaysForRight) {
    auto store = fleet_store(test_folder() / "a.gpkg", up_to(24));
    auto survey = trip_record(50);
    survey.vehicle_id = "";
    survey.t0_utc_ms = trip_record(22).t0_utc_ms;
    survey.reference = ReferenceNote{.relative_sd_ppm = 20'000, .row_mm = 20'000};
    auto passes = passes_of_fleet(1);
    for (std::size_t i = 0; i < passes.size(); ++i) { // cars 1 and 2 read a tenth too little
        passes[i].iri_um = static_cast<IriUm>((1000 + 300 * (i % 10)) * 10 / 9);
        passes[i].sd_um = passes[i].iri_um / 50;
    }
    add_trip(store, survey, passes);
    store.importer.refresh();
    const auto report = store.maintenance.calibrate();
    EXPECT_EQ(report.surveys, 1U);
    EXPECT_NEAR(report.components.anchor_relative_sd, 0.02, 0.01);
    // Cars that differ from the survey by the same everywhere misread no place alike; what is
    // stated counts as much as 40 places.
    const FusionConfig stated;
    EXPECT_LT(report.components.max_common_relative_sd, stated.max_common_relative_sd);
    EXPECT_GT(report.components.max_common_relative_sd, 0);
    EXPECT_GE(report.components.common_share, stated.common_share);
    ASSERT_THAT(report.cars, SizeIs(3));
    std::vector<double> at_2000;
    for (const auto& car : report.cars) {
        at_2000.push_back(car.calibration->gain + car.calibration->offset_um / 2000);
    }
    std::ranges::sort(at_2000);
    EXPECT_NEAR(at_2000[0], 0.9, 0.02);
    EXPECT_NEAR(at_2000[2], 1.25 * 0.9, 0.03);
}

TEST(Calibrate, ChangesNothingWhenOnlyAsked) {
    auto store = fleet_store(test_folder() / "a.gpkg", up_to(12));
    const auto before = store.digest();
    const auto report = store.estimate_calibration();
    EXPECT_TRUE(report.cars[0].calibration);
    EXPECT_EQ(store.digest(), before);
    EXPECT_EQ(store.info().generation, 1);
}

TEST(Calibrate, ComesToTheSameWhateverTheOrderOfImport) {
    const auto folder = test_folder();
    auto straight = fleet_store(folder / "straight.gpkg", up_to(12));
    auto order = up_to(12);
    std::ranges::reverse(order);
    auto reversed = fleet_store(folder / "reversed.gpkg", order);
    straight.maintenance.calibrate();
    reversed.maintenance.calibrate();
    EXPECT_EQ(reversed.digest(), straight.digest());
}

TEST(Calibrate, HoldsForTripsThatComeLater) {
    const auto folder = test_folder();
    const auto calibrated = [&](const char* name, bool refresh_often) {
        auto store = fleet_store(folder / name, up_to(12));
        store.maintenance.calibrate();
        for (const int number : {13, 12, 14}) {
            add_trip(store, trip_record(number), passes_of_fleet(number));
            if (refresh_often) {
                store.importer.refresh();
            }
        }
        store.importer.refresh();
        return store.digest();
    };
    EXPECT_EQ(calibrated("often.gpkg", true), calibrated("once.gpkg", false));
}

TEST(Calibrate, IsForgottenWithTheTripsThatItCameFrom) {
    const auto folder = test_folder();
    auto store = fleet_store(folder / "a.gpkg", up_to(14));
    store.maintenance.calibrate();
    add_trip(store, trip_record(20), passes_of_fleet(20)); // the calibration is not from it
    store.importer.refresh();
    EXPECT_TRUE(store.maintenance.forget({.trips = {"trip-5"}, .vehicles = {}}).calibrated);

    auto never = fleet_store(folder / "never.gpkg", without(up_to(14), 5));
    never.maintenance.calibrate();
    add_trip(never, trip_record(20), passes_of_fleet(20));
    never.importer.refresh();
    EXPECT_EQ(store.digest(), never.digest());

    EXPECT_FALSE(store.maintenance.forget({.trips = {"trip-20"}, .vehicles = {}}).calibrated);
}

TEST(Calibrate, LeavesCarsWithoutAnIdAndLonelyOnesAsTheyAre) {
    auto store = new_store(test_folder() / "a.gpkg");
    for (const int number : up_to(12)) {
        auto record = trip_record(number);
        record.vehicle_id = number % 3 == 0 ? "" : record.vehicle_id;
        add_trip(store, record, passes_of_fleet(number));
    }
    auto lonely = trip_record(90);
    lonely.vehicle_id = "car-90";
    auto passes = passes_of_fleet(90);
    passes.resize(5);
    add_trip(store, lonely, passes);
    store.importer.refresh();
    const auto report = store.maintenance.calibrate();
    ASSERT_THAT(report.cars, SizeIs(3)); // car-1, car-2 and the lonely one
    EXPECT_THAT(store.usage().calibrated_cars, SizeIs(2));
}

// -------------------------------------------------------------------------------------- reprocess

TEST(Reprocess, PutsWhatTripsSayNowInPlaceOfWhatTheySaid) {
    const auto folder = test_folder();
    auto store = store_of(folder / "a.gpkg", up_to(6));
    auto anew = trip_record(2);
    anew.method = "smoother";
    EXPECT_TRUE(stage_trip(store, anew, passes_of(102), {}));
    EXPECT_TRUE(stage_trip(store, trip_record(3), passes_of(900), {}));
    EXPECT_TRUE(stage_trip(store, trip_record(3), passes_of(103), {})); // the last word counts
    EXPECT_FALSE(stage_trip(store, trip_record(50), passes_of(50), {}));

    const auto before = store_of(folder / "before.gpkg", up_to(6)).digest();
    EXPECT_EQ(StoreReader::open(folder / "a.gpkg").digest(), before);

    const auto done = store.maintenance.commit_staged("method smoother");
    EXPECT_EQ(done.generation, 2);
    EXPECT_EQ(done.trips, 2U);
    EXPECT_EQ(done.others, 4U);

    auto expected = new_store(folder / "expected.gpkg");
    for (const int number : up_to(6)) {
        const int says = number == 2 || number == 3 ? 100 + number : number;
        add_trip(expected, number == 2 ? anew : trip_record(number), passes_of(says));
    }
    expected.importer.refresh();
    EXPECT_EQ(store.digest(), expected.digest());
    EXPECT_EQ(store.audit().back().detail,
              "method smoother; trips: 2 worked out anew, 4 as they were");
    const auto uses = store.usage().vehicles;
    EXPECT_EQ(std::ranges::count(uses, std::string{"smoother"}, &VehicleUse::method), 1);
}

/// The limit of the error common to all cars depends on the method.
TEST(Reprocess, FusesByTheNewMethodOfATrip) {
    const auto folder = test_folder();
    for (const auto& [before, after] : {std::pair{"kf", "smoother"}, {"smoother", "kf"}}) {
        auto store = unsure_store(folder / (std::string{before} + "-old.gpkg"), before);
        const auto old = store.digest();
        for (const int number : up_to(6)) {
            EXPECT_TRUE(stage_trip(store, trip_by(after, number), unsure_passes(number), {}));
        }
        store.maintenance.commit_staged(after);
        EXPECT_NE(store.digest(), old);
        const auto fresh = unsure_store(folder / (std::string{after} + "-new.gpkg"), after);
        EXPECT_EQ(store.digest(), fresh.digest()) << after;
    }
}

TEST(Reprocess, LeavesOutATripThatWasForgottenMeanwhile) {
    const auto folder = test_folder();
    auto store = store_of(folder / "a.gpkg", up_to(4));
    stage_trip(store, trip_record(1), passes_of(101), {});
    RoadStore::open(folder / "a.gpkg").maintenance.forget({.trips = {"trip-1"}, .vehicles = {}});
    EXPECT_EQ(store.maintenance.commit_staged("anew").trips, 0U);
    EXPECT_EQ(store.digest(), store_of(folder / "b.gpkg", {0, 2, 3}).digest());
}

TEST(Reprocess, RefusesToGoOnFromAnotherGeneration) {
    const auto folder = test_folder();
    auto store = fleet_store(folder / "a.gpkg", up_to(12));
    stage_trip(store, trip_record(1), passes_of(101), {});
    RoadStore::open(folder / "a.gpkg").maintenance.calibrate();
    const auto before = store.digest();
    EXPECT_THAT(refusal_of([&] { store.maintenance.commit_staged("anew"); }),
                HasSubstr("a.gpkg: another command wrote a new generation in the meantime"));
    EXPECT_EQ(store.digest(), before);
}

TEST(Reprocess, CalibratesTheCarsAnew) {
    const auto folder = test_folder();
    auto store = fleet_store(folder / "a.gpkg", up_to(12));
    store.maintenance.calibrate();
    stage_trip(store, trip_record(4), passes_of_fleet(3), {}); // as if its car read too high
    EXPECT_TRUE(store.maintenance.commit_staged("anew").calibrated);

    auto expected = new_store(folder / "expected.gpkg");
    for (const int number : up_to(12)) {
        add_trip(expected, trip_record(number), passes_of_fleet(number == 4 ? 3 : number));
    }
    expected.importer.refresh();
    expected.maintenance.calibrate();
    EXPECT_EQ(store.digest(), expected.digest());
}

} // namespace
} // namespace macadam::testing
