#pragma once

#include "storage/store/road_store.hpp"

#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace macadam::testing {

// A crowd of commuters in a made-up town, for tests that take publications apart.

inline constexpr int town_side = 26;        // crossings
inline constexpr double town_block_m = 160; // between them
inline constexpr int arterial_every = 5;    // rows and columns
inline constexpr int town_cars = 64;

/// What one trip of it really was, and what of it came into the store.
struct CrowdTrip {
    int car;
    int month; ///< 0, 1, ...
    GeoPoint begin;
    GeoPoint end;
    std::vector<SegmentKey> driven; ///< the whole way
    std::vector<Pass> kept;
    std::string sha256;
};

class CrowdTown {
public:
    CrowdTown();

    const RoadNetwork& roads() const { return roads_; }

    /// The trips of a month: each car between its home and its work, and an errand now and then.
    /// \param active  how many of the cars drive
    std::vector<CrowdTrip> trips_of(int month, const PrivacyKey& key, int active = town_cars);

    const GeoPoint& home(int car) const { return cars_[static_cast<std::size_t>(car)].home_at; }

    GeoPoint middle_of(const SegmentKey& segment) const;

private:
    struct Car {
        int home;
        int work;
        GeoPoint home_at;
    };

    std::vector<int> way_between(int from, int to) const;
    CrowdTrip drive(int car, int month, int from, int to, const PrivacyKey& key);

    RoadNetwork roads_;
    std::vector<GeoPoint> crossings_;
    std::vector<Car> cars_;
    std::mt19937_64 random_{7};
    int trips_ = 0;
};

std::int64_t begin_of_month_ms(int month); ///< 0 = January 2026

/// Adds them to the store as an import does.
void add_to(RoadStore& store, const std::vector<CrowdTrip>& trips);

} // namespace macadam::testing
