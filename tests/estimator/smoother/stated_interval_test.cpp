// Whether the stated interval holds what it says, of cars that are not quite what is said of them.

#include "bounds.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <functional>
#include <future>
#include <random>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;
constexpr double relative_sd = 0.05;
constexpr std::array speeds_kmh{50.0, 80.0, 110.0};

/// Beside the worlds, whose strokes have a kurtosis below 10.
constexpr World heavy_tailed{"10 potholes a km, MRI 2.5",
                             {.iri_mm_per_m = 2.5, .potholes_per_km = 10},
                             {.wheelbase_m = 2.7, .cg_to_front_m = 1.25},
                             0.3};

/// What the file says of a car: each parameter is off by as much as it says that it may be.
Vehicle as_stated(Vehicle car, std::uint64_t seed) {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> off{1, relative_sd};
    const auto state = [&](const char* name, double& value) {
        value *= off(random);
        car.uncertainty[name] = relative_sd;
    };
    state("ms_kg", car.half_car.ms_kg);
    state("mu_kg", car.half_car.mu_kg);
    state("ks_n_per_m", car.half_car.ks_n_per_m);
    state("cs_ns_per_m", car.half_car.cs_ns_per_m);
    state("kt_n_per_m", car.half_car.kt_n_per_m);
    state("is_kgm2", car.half_car.is_kgm2);
    return car;
}

/// A piece of road, and what kind of drive it belongs to.
struct Driven {
    Held held; ///< mm/m
    double speed_kmh, kurtosis;
};

/// Many cars on short drives: what is wrong with a car is wrong on every metre that it drives.
std::vector<Driven> drives_at(double speed_kmh) {
    constexpr std::uint64_t cars = 2;
    std::vector<Driven> driven;
    std::uint64_t seed = static_cast<std::uint64_t>(speed_kmh);
    std::vector<World> roads{worlds().begin(), worlds().end()};
    roads.push_back(heavy_tailed);
    for (const auto& world : roads) {
        for (std::uint64_t car = 0; car < cars; ++car) {
            auto recipe = drive_in(world, speed_kmh);
            recipe.seed = ++seed;
            const auto stated = as_stated(recipe.car.vehicle, seed);
            const auto [stretch, truth] = driven_road(recipe);
            for (const auto& piece : held_beside(smoothed(stretch, stated, every_sensor),
                                                 truth,
                                                 Index::mri,
                                                 segment_m,
                                                 stated)) {
                driven.push_back({piece, speed_kmh, truth.kurtosis});
            }
        }
    }
    return driven;
}

std::vector<Driven> all_drives() {
    std::vector<std::future<std::vector<Driven>>> by_speed;
    for (const double speed_kmh : speeds_kmh) {
        by_speed.push_back(std::async(std::launch::async, drives_at, speed_kmh));
    }
    std::vector<Driven> all;
    for (auto& drives : by_speed) {
        const auto some = drives.get();
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

/// What is from `from` to below `to` of something.
struct Band {
    const char* of;
    std::function<double(const Driven&)> measure;
    double from, to;
};

/// Of the pieces' truths, how many at most may lie outside and inside the interval.
struct Shares {
    Bound outside, inside;
};
// Missed on the safe side: these cars are linear, but their interval also allows for dampers and
// friction that no vehicle file describes (4 %), beside the mass and damping that are not tuned.
constexpr Shares of_all{.outside = {.wanted = 0.13}, .inside = {.wanted = 0.93, .reached = 0.97}};
constexpr Shares of_a_band{.outside = {.wanted = 0.20},
                           .inside = {.wanted = 0.97, .reached = 0.995}};

std::vector<Band> bands() {
    const auto speed = [](const Driven& d) { return d.speed_kmh; };
    const auto mri = [](const Driven& d) { return d.held.truth; };
    const auto kurtosis = [](const Driven& d) { return d.kurtosis; };
    return {{"speed, km/h", speed, 40, 65},
            {"speed, km/h", speed, 65, 95},
            {"speed, km/h", speed, 95, 130},
            {"MRI, mm/m", mri, 0, 1.5},
            {"MRI, mm/m", mri, 1.5, 3},
            {"MRI, mm/m", mri, 3, 20},
            {"kurtosis", kurtosis, 0, 5},
            {"kurtosis", kurtosis, 5, 10},
            {"kurtosis", kurtosis, 10, 100}};
}

std::vector<Held> within(const Band& band, const std::vector<Driven>& driven) {
    std::vector<Held> pieces;
    for (const auto& piece : driven) {
        const double measure = band.measure(piece);
        if (measure >= band.from && measure < band.to) {
            pieces.push_back(piece.held);
        }
    }
    return pieces;
}

void expect_covered(const Band& band, const std::vector<Driven>& driven, const Shares& most) {
    const auto pieces = within(band, driven);
    ASSERT_GT(pieces.size(), 50U) << band.of << ' ' << band.from;
    const auto errors = errors_of(pieces);
    std::printf("%-12s %3g to %3g: interval covers %3.0f %% of %4zu, bias %+5.1f %%\n",
                band.of,
                band.from,
                band.to,
                100 * errors.covered,
                pieces.size(),
                100 * errors.bias);
    expect_at_most("share outside the interval", 1 - errors.covered, most.outside);
    expect_at_most("share inside the interval", errors.covered, most.inside);
}

TEST(StatedInterval, HoldsWhatItSaysOfCarsDrawnFromTheirUncertainty) {
    const auto driven = all_drives();
    const auto any = [](const Driven&) { return 0.0; };
    expect_covered({"all", any, 0, 1}, driven, of_all);
    for (const auto& band : bands()) {
        expect_covered(band, driven, of_a_band);
    }
}

} // namespace
} // namespace macadam::testing
