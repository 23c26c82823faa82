// Databases on any engine that fuse only some trips of a car over a segment in a month.

#include "support/files/files.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

/// Trip of one month over way 1: of the first two cars, or of an unknown one.
RichTrip limited_trip(int number) {
    RichTrip trip{number};
    trip.record.t0_utc_ms = 1'767'225'600'000 + std::int64_t{86'400'000} * (1 + number);
    if (number % 3 == 2) {
        trip.record.vehicle_id.clear();
    }
    return trip;
}

void import_limited_trips(ImportTarget& trips, const std::vector<int>& numbers) {
    for (const int number : numbers) {
        const auto trip = limited_trip(number);
        const auto one = trip.as_new();
        trips.add_trips({&one, 1});
        if (number % 4 == 0) {
            fuse_all(trips);
        }
    }
    fuse_all(trips);
}

/// Passes from which the first segment is fused.
std::int32_t passes_in(const StoreReader& store) {
    SegmentFilter first;
    first.key = SegmentKey{1, true, 0};
    std::int32_t passes = 0;
    store.visit(first, [&](const SegmentRecord& record) { passes = record.state.value().passes; });
    return passes;
}

class LimitedDatabaseOnAnyEngine : public ::testing::TestWithParam<Engine> {
protected:
    static constexpr int limit = 2;
    static StoreSettings limited() {
        auto limited = settings();
        limited.max_trips_per_car_month = limit;
        return limited;
    }

    std::filesystem::path folder_ = test_folder();
    EngineDatabase database_{GetParam(), folder_, small_country(), limited()};
};

INSTANTIATE_TEST_SUITE_P(Engines,
                         LimitedDatabaseOnAnyEngine,
                         ::testing::Values(Engine::geopackage, Engine::postgresql),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(LimitedDatabaseOnAnyEngine, FusesAsManyTripsOfACarInAMonthAlsoAfterForgetting) {
    constexpr int cars = 2, trips_each = 4;
    std::vector<int> numbers;
    for (int number = 0; number < 3 * trips_each; ++number) {
        numbers.push_back(number);
    }
    import_limited_trips(*database_.import().trips, numbers);
    EXPECT_EQ(passes_in(database_.read()), limit * cars + trips_each); // all of unknown cars
    const auto in_file = [&](const std::string& name, std::vector<int> some) {
        std::ranges::reverse(some);
        auto store = RoadStore::create(folder_ / name, small_country(), limited());
        import_limited_trips(*import_store_of(store).trips, some);
        return store.digest();
    };
    EXPECT_EQ(database_.read().digest(), in_file("all.gpkg", numbers));

    // The lowest hash of the first car gives its place to the next one; unknown cars have none.
    std::vector<int> of_car{0, 3, 6, 9};
    const int lowest = *std::ranges::min_element(
        of_car, {}, [](int number) { return trip_record(number).sha256; });
    constexpr int unknown = 5;
    database_.forget(
        {.trips = {trip_record(lowest).sha256, trip_record(unknown).sha256}, .vehicles = {}});
    std::erase_if(numbers, [&](int number) { return number == lowest || number == unknown; });
    EXPECT_EQ(passes_in(database_.read()), limit * cars + trips_each - 1);
    EXPECT_EQ(database_.read().digest(), in_file("others.gpkg", numbers));
}

} // namespace
} // namespace macadam::testing
