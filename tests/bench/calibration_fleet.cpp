// Makes the database of a large fleet for measuring `calibrate` and `info`: trips go straight into
// the database, without simulated sensors.
//
//     calibration_fleet FILE.gpkg [SIDE]   crossings along a side of the town; 100 (10,000 cars, 10
//                                          million passes) unless given
//
// A town of N segments has N / 20 cars. Each drives ten trips of 100 consecutive segments on ten
// days near its home, so that cars overlap with few others. Cars differ by 6 %, trips by 2 %,
// passes by 7 %; one car in a hundred reads 12 % more after five trips.

#include "driven_town.hpp"
#include "estimator/common/error.hpp"
#include "storage/store/road_store.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace macadam {
namespace {

using namespace bench;

constexpr std::size_t segments_a_car = 20;
constexpr int trips_a_car = 10;
constexpr std::size_t passes_a_trip = 100;
constexpr std::size_t near_home = 2000; // segments
constexpr int trips_at_once = 2000;

class Fleet {
public:
    explicit Fleet(std::span<const SegmentKey> keys) : keys_{keys} {}

    /// Trip of a car, which differs from another by a seed of its own.
    std::vector<Pass> passes_of(int car, int trip) const {
        std::mt19937 of_car{static_cast<unsigned>(car)};
        const double gain = 1 + 0.06 * std::normal_distribution<double>{}(of_car);
        const bool changes = car % 100 == 0 && trip >= trips_a_car / 2;
        std::mt19937 of_trip{static_cast<unsigned>(car * trips_a_car + trip) + 1'000'000};
        std::normal_distribution<double> normal;
        const double reads = gain * (1 + 0.02 * normal(of_trip)) * (changes ? 1.12 : 1);
        const auto home = static_cast<std::size_t>(car) * segments_a_car;
        const auto first = std::min(home + of_trip() % near_home, keys_.size() - passes_a_trip);
        return passes_over(keys_.subspan(first, passes_a_trip), [&](std::int64_t number) {
            const auto place = first + static_cast<std::size_t>(number);
            const double level_um = 1000 + 250 * static_cast<double>(place % 13);
            return std::max(100.0, level_um * reads * (1 + 0.07 * normal(of_trip)));
        });
    }

private:
    std::span<const SegmentKey> keys_;
};

TripRecord record_of(int car, int trip) {
    auto record = trip_number(car * trips_a_car + trip);
    record.vehicle_id = fmt::format("car-{}", car);
    record.t0_utc_ms = 1'767'225'600'000 + 86'400'000LL * (12 * trip + car % 12);
    return record;
}

void make(const std::filesystem::path& file, int side) {
    const auto roads = testing::made_up_town(side);
    const auto keys = keys_of(roads);
    RoadStore::create(file, roads, {});
    auto store = RoadStore::open(file, RoadStore::Access::write);
    const Fleet fleet{keys};
    const auto trips = static_cast<int>(keys.size() / segments_a_car) * trips_a_car;
    for (int first = 0; first < trips; first += trips_at_once) {
        std::vector<TripRecord> records;
        std::vector<std::vector<Pass>> passes;
        for (int i = first; i < std::min(trips, first + trips_at_once); ++i) {
            records.push_back(record_of(i / trips_a_car, i % trips_a_car));
            passes.push_back(fleet.passes_of(i / trips_a_car, i % trips_a_car));
        }
        std::vector<NewTrip> batch;
        for (std::size_t i = 0; i < records.size(); ++i) {
            batch.push_back({&records[i], passes[i], {}});
        }
        store.add_trips(batch);
    }
    fmt::print("{} cars, {} passes, {} segments\n",
               trips / trips_a_car,
               static_cast<std::size_t>(trips) * passes_a_trip,
               keys.size());
}

} // namespace
} // namespace macadam

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: calibration_fleet FILE.gpkg [SIDE]\n");
        return 2;
    }
    try {
        macadam::make(argv[1], argc > 2 ? std::atoi(argv[2]) : 100);
    } catch (const macadam::InputError& error) {
        fmt::print(stderr, "calibration_fleet: {}\n", error.what());
        return 1;
    }
    return 0;
}
