// Databases that fuse only some trips of a car over a segment in a month.

#include "storage/store/road_store.hpp"

#include "mapping/passes/chunk_trace.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using testing::passes_of;
using testing::small_country;
using testing::test_folder;
using testing::trip_record;

constexpr int trip_count = 18;
constexpr std::int64_t max_trips = 2;

/// Trips of three cars over way 1 in two months: three to a car and month, of which two are fused.
TripRecord trip(int number) {
    auto record = trip_record(number);
    record.t0_utc_ms =
        1'767'225'600'000 + std::int64_t{86'400'000} * (1 + number + (number % 2) * 40);
    return record;
}

void add(RoadStore& store, int number) {
    auto passes = passes_of(number);
    for (auto& pass : passes) {
        pass.drive = 0;
    }
    const RoughnessTrace trace{.chunk = {1, true, 0},
                               .drive = 0,
                               .first_m = -10,
                               .iri = std::vector<RoughnessCode>(220, code_of(1.0 + number)),
                               .left = {},
                               .place_sd_mm = 900};
    testing::add_trip(store, trip(number), passes, {&trace, 1});
}

class LimitedStores : public ::testing::Test {
protected:
    /// Database with trips, imported in this order and fused now and then.
    RoadStore filled(const std::string& name, std::int64_t limit, const std::vector<int>& numbers) {
        auto settings = testing::settings();
        settings.max_trips_per_car_month = limit;
        auto store = RoadStore::create(folder_ / name, small_country(), settings);
        for (const int number : numbers) {
            add(store, number);
            if (number % 5 == 0) {
                store.importer.refresh();
            }
        }
        store.importer.refresh();
        return store;
    }

    std::filesystem::path folder_ = test_folder();
};

std::vector<int> all_trips() {
    std::vector<int> numbers(trip_count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

/// The two lowest hashes of each car and month, found by sorting.
std::vector<int> chosen_trips(const std::vector<int>& numbers) {
    std::map<std::pair<std::string, int>, std::vector<std::pair<std::string, int>>> groups;
    for (const int number : numbers) {
        groups[{trip(number).vehicle_id, number % 2}].emplace_back(trip(number).sha256, number);
    }
    std::vector<int> chosen;
    for (auto& [key, trips] : groups) {
        std::ranges::sort(trips);
        for (std::size_t i = 0; i < std::min<std::size_t>(max_trips, trips.size()); ++i) {
            chosen.push_back(trips[i].second);
        }
    }
    return chosen;
}

std::vector<std::string> states_of(const RoadStore& store) {
    std::vector<std::string> states;
    store.visit({}, [&](const SegmentRecord& record) {
        if (record.state) {
            states.push_back(std::to_string(record.state->iri_um) + " " +
                             std::to_string(record.state->sd_um) + " " +
                             std::to_string(record.state->passes) + " " +
                             std::to_string(record.state->vehicles));
        }
    });
    return states;
}

TEST_F(LimitedStores, FuseWhatTheLowestHashesOfEachCarAndMonthWouldGiveAlone) {
    const auto store = filled("limited.gpkg", max_trips, all_trips());
    const auto chosen = chosen_trips(all_trips());
    ASSERT_EQ(chosen.size(), 12U);
    const auto states = states_of(store);
    EXPECT_EQ(states.size(), 20U);
    EXPECT_EQ(states, states_of(filled("chosen.gpkg", 0, chosen)));
    EXPECT_NE(states, states_of(filled("unlimited.gpkg", 0, all_trips())));
    EXPECT_EQ(store.info().trips, 18U); // all are kept
}

TEST_F(LimitedStores, HaveOneDigestInAnyOrderOfImport) {
    auto numbers = all_trips();
    const auto digest = filled("first.gpkg", max_trips, numbers).digest();
    std::mt19937 random{3};
    for (int order = 0; order < 3; ++order) {
        std::ranges::shuffle(numbers, random);
        EXPECT_EQ(filled(std::to_string(order) + ".gpkg", max_trips, numbers).digest(), digest);
    }
}

TEST_F(LimitedStores, AreAfterForgettingAsIfTheTripHadNeverCome) {
    auto store = filled("forgets.gpkg", max_trips, all_trips());
    auto numbers = all_trips();
    const int fused = chosen_trips(numbers).front();
    store.maintenance.forget({.trips = {trip(fused).sha256}, .vehicles = {}});
    std::erase(numbers, fused);
    EXPECT_EQ(store.digest(), filled("never.gpkg", max_trips, numbers).digest());
    EXPECT_EQ(states_of(store), states_of(filled("chosen.gpkg", 0, chosen_trips(numbers))));
}

TEST_F(LimitedStores, KeepTheirLimitWhenCarsAreCalibrated) {
    auto store = filled("calibrated.gpkg", max_trips, all_trips());
    store.maintenance.calibrate({});
    EXPECT_EQ(RoadStore::open(folder_ / "calibrated.gpkg").settings().max_trips_per_car_month,
              max_trips);
    std::int32_t passes = 0;
    store.visit({}, [&](const SegmentRecord& record) {
        passes = std::max(passes, record.state ? record.state->passes : 0);
    });
    EXPECT_EQ(passes, 12);
}

} // namespace
} // namespace macadam
