// Cars that change, from their passes in a database to the calibration of their periods.

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int cars = 4;
constexpr int trips_of_car = 12;
constexpr int first_changed = 6;
constexpr std::int64_t begin_ms = 1'770'000'000'000;
constexpr std::int64_t day_ms = 86'400'000;

TripRecord record_of(int car, int trip) {
    auto record = trip_record(cars * trip + car);
    record.vehicle_id = "car-" + std::to_string(car);
    record.t0_utc_ms = begin_ms + 2 * day_ms * trip + 3'600'000 * car;
    return record;
}

/// Trip over 120 segments. \param changing  car that reads 20 % more from its seventh trip on
std::vector<Pass> passes_of_car(const RoadNetwork& roads, int car, int trip, int changing) {
    std::mt19937 random{static_cast<unsigned>(100 * car + trip)};
    std::normal_distribution<double> normal;
    const double reads = (1 + 0.02 * normal(random)) * (1 + 0.03 * car) *
                         (car == changing && trip >= first_changed ? 1.2 : 1);
    std::vector<Pass> passes;
    for (std::uint32_t link = 0; passes.size() < 120; ++link) {
        const auto edge = edge_of(LinkId{link}, true);
        for (const auto& segment :
             is_drivable(roads, edge) ? segments_of(roads, edge) : std::vector<Segment>{}) {
            Pass pass{};
            pass.segment = segment.key;
            const double level_um = 1000 + 300.0 * static_cast<double>(passes.size() % 10);
            pass.iri_um = static_cast<IriUm>(level_um * reads * (1 + 0.05 * normal(random)));
            pass.sd_um = pass.iri_um / 10;
            pass.speed_mmps = 14000;
            pass.covered_mm = 20000;
            pass.confidence_ppm = 990000;
            pass.t_ms = 1000 * static_cast<std::int64_t>(passes.size());
            passes.push_back(pass);
        }
    }
    return passes;
}

RoadStore town_store(const std::filesystem::path& file, int changing, bool reversed = false) {
    const auto roads = made_up_town(5);
    auto store = RoadStore::create(file, roads, {});
    for (int i = 0; i < cars * trips_of_car; ++i) {
        const int number = reversed ? cars * trips_of_car - 1 - i : i;
        const int car = number % cars, trip = number / cars;
        store.add_trip(record_of(car, trip), passes_of_car(roads, car, trip, changing));
    }
    store.refresh();
    return store;
}

SegmentFilter driven() {
    SegmentFilter filter;
    filter.min_passes = 1;
    return filter;
}

const CalibratedCar& changed_car(const std::vector<CalibratedCar>& found) {
    const auto car = std::ranges::find_if(
        found, [](const CalibratedCar& each) { return !each.periods.empty(); });
    EXPECT_NE(car, found.end());
    return *car;
}

TEST(CarChange, IsFoundAndKeptInTheDatabase) {
    const auto file = test_folder() / "a.gpkg";
    auto store = town_store(file, 2);
    const auto report = store.calibrate(true);
    ASSERT_THAT(report.cars, SizeIs(4));
    const auto& found = changed_car(report.cars);
    ASSERT_THAT(found.periods, SizeIs(2));
    EXPECT_NEAR(static_cast<double>(*found.periods[1].from_ms - *record_of(2, 6).t0_utc_ms),
                0,
                2.0 * 2 * day_ms); // a trip or two
    EXPECT_NEAR(found.periods[1].change->level, 0.2, 0.05);
    EXPECT_EQ(found.calibration, found.periods[1].calibration);
    EXPECT_EQ(
        std::ranges::count_if(report.cars, [](const auto& car) { return car.periods.empty(); }), 3);

    const auto kept = RoadStore::open(file, RoadStore::Access::read).calibrated_cars();
    const auto& read = changed_car(kept);
    EXPECT_EQ(read.vehicle, found.vehicle);
    ASSERT_THAT(read.periods, SizeIs(2));
    EXPECT_EQ(read.periods[1].from_ms, found.periods[1].from_ms);
    EXPECT_NEAR(read.periods[1].change->level, found.periods[1].change->level, 1e-6);
    EXPECT_NEAR(read.periods[0].calibration->gain, found.periods[0].calibration->gain, 1e-6);
}

TEST(CarChange, LeavesTheMapAsItWouldBeWithoutIt) {
    const auto folder = test_folder();
    auto changed = town_store(folder / "changed.gpkg", 2);
    auto steady = town_store(folder / "steady.gpkg", -1);
    changed.calibrate(true);
    steady.calibrate(true);
    std::vector<double> levels;
    steady.visit(driven(), [&](const SegmentRecord& record) {
        levels.push_back(record.state->iri_um);
        EXPECT_EQ(record.state->vehicles, 4); // one car in two periods is one car
    });
    ASSERT_GE(levels.size(), 120U);
    double ratio = 0;
    std::size_t i = 0;
    changed.visit(driven(), [&](const SegmentRecord& record) {
        EXPECT_EQ(record.state->vehicles, 4);
        ratio += record.state->iri_um / levels.at(i++);
    });
    // The mean of the cars moves with the one that reads more: by half of its 20 % in a fourth.
    EXPECT_NEAR(ratio / static_cast<double>(i), 1, 0.03);
}

TEST(CarChange, DoesNotDependOnTheOrderOfImport) {
    const auto folder = test_folder();
    auto straight = town_store(folder / "straight.gpkg", 1);
    auto reversed = town_store(folder / "reversed.gpkg", 1, true);
    straight.calibrate(true);
    reversed.calibrate(true);
    EXPECT_EQ(straight.digest(), reversed.digest());
}

TEST(CarChange, GoesWithTheCarThatIsForgotten) {
    const auto folder = test_folder();
    auto store = town_store(folder / "a.gpkg", 2);
    store.calibrate(true);
    store.forget({.trips = {}, .vehicles = {"car-2"}});
    ASSERT_THAT(store.calibrated_cars(), SizeIs(3));
    for (const auto& car : store.calibrated_cars()) {
        EXPECT_THAT(car.periods, IsEmpty());
    }
    Database database{folder / "a.gpkg", Database::Access::read};
    EXPECT_EQ(database.number("SELECT count(*) FROM calibration_period"), 0);
}

} // namespace
} // namespace macadam::testing
