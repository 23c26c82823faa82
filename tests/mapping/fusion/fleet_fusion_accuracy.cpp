// Fleets with known truth: what the fused numbers and their intervals are worth.

#include "mapping/fusion/fleet/changing_fleet.hpp"
#include "mapping/fusion/fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

namespace macadam {
namespace {

constexpr double ms_per_year = 365.25 * 86400e3;
constexpr std::int64_t begin_ms = 1'700'000'000'000;

/// 20 cars that read 6 % wrong each, in 200 trips that add 2 %, and 6 % that no two passes share.
struct Fleet {
    int cars = 20;
    int trips = 200;
    double car_sd = 0.06;
    double trip_sd = 0.02;
    double rest_sd = 0.06;
    double years = 2;
    double share = 1; ///< of the segments that a trip passes
};

FusionConfig components_of(const Fleet& fleet) {
    FusionConfig config;
    config.common_share = 0;
    config.car_share = 1;
    config.trip_relative_sd = fleet.trip_sd;
    config.rest_relative_sd = fleet.rest_sd;
    config.rest_sd_mm_per_m = 0;
    return config;
}

/// True level of a segment in um/m, years after the first trip.
using Road = std::function<double(std::size_t segment, double years)>;
using Passes = std::vector<std::vector<FusionInput>>; ///< of each segment

FusionInput pass(double read_um, int car, int trip, double years, double stated) {
    FusionInput input{};
    input.pass.iri_um = static_cast<IriUm>(std::max(1.0, read_um));
    input.pass.sd_um = static_cast<IriUm>(std::max(1.0, stated * read_um));
    input.vehicle = car;
    input.trip_sha256 = std::to_string(1000 + trip);
    input.utc_ms = begin_ms + static_cast<std::int64_t>(years * ms_per_year);
    return input;
}

Passes driven(const Fleet& fleet, const Road& road, std::size_t segments, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<double> gains;
    for (int i = 0; i < fleet.cars; ++i) {
        gains.push_back(1 + fleet.car_sd * normal(random));
    }
    Passes passes(segments);
    for (int trip = 0; trip < fleet.trips; ++trip) {
        const int car = trip % fleet.cars;
        const double years = fleet.years * uniform(random);
        const double of_trip =
            gains[static_cast<std::size_t>(car)] + fleet.trip_sd * normal(random);
        for (std::size_t s = 0; s < segments; ++s) {
            if (uniform(random) < fleet.share) {
                const double read = of_trip + fleet.rest_sd * normal(random);
                passes[s].push_back(pass(road(s, years) * read, car, trip, years, fleet.car_sd));
            }
        }
    }
    return passes;
}

double years_of(std::int64_t utc_ms) {
    return static_cast<double>(utc_ms - begin_ms) / ms_per_year;
}

/// Relative to the truth.
struct Score {
    double bias = 0, square = 0, stated_square = 0, covered = 0, count = 0;

    void add(const SegmentState& state, double truth_um) {
        const double off = state.iri_um / truth_um - 1;
        bias += off;
        square += off * off;
        stated_square += std::pow(state.sd_um / truth_um, 2);
        covered += state.low_um <= truth_um && truth_um <= state.high_um;
        ++count;
    }
    double rmse() const { return std::sqrt(square / count); }
    double stated() const { return std::sqrt(stated_square / count); }
};

void print(const char* name, const Score& s) {
    std::printf(
        "%-38s %5.0f states: bias %+.2f %%, RMSE %.2f %%, stated %.2f %%, in 90 %%: %.1f %%\n",
        name,
        s.count,
        100 * s.bias / s.count,
        100 * s.rmse(),
        100 * s.stated(),
        100 * s.covered / s.count);
}

/// Of the newest level, over fleets of different seeds: errors within one are alike.
Score score(const Fleet& fleet, const Road& road, int fleets, std::size_t segments) {
    Score score;
    for (int seed = 1; seed <= fleets; ++seed) {
        for (std::size_t s = 0;
             const auto& passes : driven(fleet, road, segments, static_cast<unsigned>(seed))) {
            if (!passes.empty()) {
                const auto state = fuse(passes, components_of(fleet));
                score.add(state, road(s, years_of(*state.last_seen_ms)));
            }
            ++s;
        }
    }
    return score;
}

double steady(std::size_t segment, double) {
    return 1000 + 250 * static_cast<double>(segment % 17);
}

/// Roads get rougher by up to 0.2 mm/m a year, one faster than another.
double ageing(std::size_t segment, double years) {
    return steady(segment, 0) + 20 * static_cast<double>(segment * 7 % 11) * years;
}

TEST(FleetFusion, ErrsAndCoversAsTheComponentsSay) {
    // Of the mean of 200 passes the cars leave 6 / sqrt 20 = 1.34 %, trips 0.14, the rest 0.42.
    const auto of_all = score({}, steady, 100, 5);
    print("20 cars, 200 passes", of_all);
    EXPECT_NEAR(of_all.rmse(), std::hypot(0.0134, 0.0014, 0.0042), 0.005);
    EXPECT_GE(of_all.covered / of_all.count, 0.86);
    EXPECT_LE(of_all.covered / of_all.count, 0.94);

    print("20 cars, 30 passes, nothing changes", score({.share = 0.15}, steady, 50, 20));
    const auto of_some = score({.share = 0.15}, ageing, 50, 20);
    print("20 cars, 30 passes, roads age", of_some);
    EXPECT_GE(of_some.covered / of_some.count, 0.86);
    EXPECT_LE(of_some.covered / of_some.count, 0.94);
}

TEST(FleetFusion, CoversWhatTenPassesOfOneCarLeaveOpen) {
    const auto of_one = score({.cars = 1, .trips = 10}, steady, 400, 3);
    print("one car, 10 passes", of_one);
    EXPECT_NEAR(of_one.rmse(), std::hypot(0.06, 0.02 / std::sqrt(10), 0.06 / std::sqrt(10)), 0.006);
    EXPECT_GE(of_one.covered / of_one.count, 0.86);
    EXPECT_LE(of_one.covered / of_one.count, 0.94);
}

TEST(FleetFusion, LetsOneBrokenCarInFiveMoveTheMedianSegmentByLessThanThreePercent) {
    double mean = 0;
    constexpr int fleets = 20;
    for (unsigned seed = 1; seed <= fleets; ++seed) {
        const Fleet fleet{.cars = 5, .trips = 50, .share = 0.3};
        std::vector<double> moved;
        for (const auto& good : driven(fleet, steady, 50, seed)) {
            auto bad = good;
            for (auto& input : bad) {
                if (input.vehicle == 3) {
                    input.pass.iri_um = input.pass.iri_um * 3 / 2;
                    input.pass.sd_um = input.pass.sd_um * 3 / 2;
                }
            }
            const auto config = components_of(fleet);
            moved.push_back(fuse(bad, config).iri_um / (1.0 * fuse(good, config).iri_um) - 1);
        }
        std::ranges::nth_element(moved, moved.begin() + 25);
        mean += moved[25] / fleets;
    }
    std::printf("one broken car in five: the median segment moves by %+.2f %%\n", 100 * mean);
    EXPECT_LT(std::abs(mean), 0.03);
}

TEST(FleetFusion, FindsAStepOfHalfAMillimetreWithinThreeMonths) {
    constexpr double years = 1.75;
    const Road resurfaced = [](std::size_t, double at) { return at > years ? 2000.0 : 2500.0; };
    const Road untouched = [](std::size_t, double) { return 2500.0; };
    int found = 0, wrong = 0, count = 0;
    double worst_years = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const Fleet fleet;
        for (const auto& passes : driven(fleet, resurfaced, 10, seed)) {
            const auto state = fuse(passes, components_of(fleet));
            ++count;
            if (state.change) {
                ++found;
                worst_years =
                    std::max(worst_years, std::abs(years_of(state.change->utc_ms) - years));
                EXPECT_NEAR(state.change->um, -500, 250); // 25 passes, 6 % from car to car
            }
        }
        for (const auto& passes : driven(fleet, untouched, 10, seed)) {
            wrong += fuse(passes, components_of(fleet)).change.has_value();
        }
    }
    std::printf("a step of -0.5 mm/m, three months on: found in %d of %d, dated within %.0f days; "
                "%d found where there is none\n",
                found,
                count,
                worst_years * 365.25,
                wrong);
    EXPECT_GE(found, count * 99 / 100);
    EXPECT_EQ(wrong, 0);
}

/// 8 cars of 20 trips, one every third day over half of the segments, of which car 0 reads 10 %
/// more and car 1 scatters three times as much from their eleventh trip on. Errors as of Fleet.
Passes driven_by_cars_that_change(std::size_t segments, unsigned seed) {
    constexpr int cars = 8, trips = 20;
    const Fleet fleet;
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    Passes passes(segments);
    for (int car = 0; car < cars; ++car) {
        const double gain = 1 + fleet.car_sd * normal(random);
        for (int trip = 0; trip < trips; ++trip) {
            const bool late = trip >= trips / 2;
            const double of_trip =
                gain * (late && car == 0 ? 1.1 : 1) + fleet.trip_sd * normal(random);
            const double rest_sd = fleet.rest_sd * (late && car == 1 ? 3 : 1);
            const double years = (3 * trip + 0.3 * car) / 365.25;
            const auto first = random() % segments;
            for (std::size_t i = 0; i < segments / 2; ++i) {
                const auto s = (first + i) % segments;
                passes[s].push_back(
                    pass(steady(s, 0) * std::max(0.1, of_trip + rest_sd * normal(random)),
                         car,
                         trips * car + trip,
                         years,
                         fleet.car_sd));
            }
        }
    }
    return passes;
}

/// Calibrates the fleet of these passes. \param search  without rounds, no car changes.
ChangingFleet calibration_of(const Passes& passes, std::size_t cars, const ChangeSearch& search) {
    std::vector<FleetReading> readings;
    FleetTrips trips{std::vector<std::optional<std::int64_t>>(200),
                     std::vector<std::uint32_t>(200)};
    for (std::uint32_t place = 0; place < passes.size(); ++place) {
        for (const auto& input : passes[place]) {
            const auto trip = static_cast<std::uint32_t>(std::stoi(input.trip_sha256) - 1000);
            const auto car = static_cast<std::uint32_t>(input.vehicle);
            trips.utc_ms[trip] = input.utc_ms;
            trips.car[trip] = car;
            readings.push_back({place, car, trip, static_cast<double>(input.pass.iri_um)});
        }
    }
    return calibrate_changing_fleet(
        readings, trips, std::vector<std::optional<double>>(cars), {}, {}, search);
}

/// Fuses the passes by a calibration. Errors are relative to the mean of the cars before they
/// changed, which no calibration by cars alone can improve.
Score score_of(Passes passes, const ChangingFleet& found) {
    FusionConfig config = components_of({});
    config.trip_relative_sd = found.parts.trip_sd;
    config.rest_relative_sd = found.parts.rest_sd;
    config.anchor_relative_sd = found.parts.anchor_sd;
    Score score;
    for (std::size_t s = 0; s < passes.size(); ++s) {
        for (auto& input : passes[s]) {
            const auto& periods = found.cars[static_cast<std::size_t>(input.vehicle)];
            input.period = static_cast<std::uint32_t>(period_at(periods, input.utc_ms));
            input.calibration = periods[input.period].calibration;
        }
        score.add(fuse(passes[s], config), steady(s, 0));
    }
    return score;
}

TEST(FleetFusion, ErrsLessWhereCarsThatChangeAreToldApart) {
    Score as_one, apart;
    int found_changes = 0, false_changes = 0;
    constexpr int fleets = 20;
    for (unsigned seed = 1; seed <= fleets; ++seed) {
        const auto passes = driven_by_cars_that_change(300, seed);
        const auto one = calibration_of(passes, 8, {.min_scatter = 1e9, .max_rounds = 0});
        const auto told = calibration_of(passes, 8, {});
        for (std::size_t car = 0; car < 8; ++car) {
            const auto changes = static_cast<int>(told.cars[car].size()) - 1;
            (car < 2 ? found_changes : false_changes) += changes;
        }
        for (const auto& [score, found] : {std::pair{&as_one, &one}, std::pair{&apart, &told}}) {
            const auto fleet = score_of(passes, *found);
            // Without what is common to all segments of a fleet: the mean of its cars.
            const double common = fleet.bias / fleet.count;
            score->square += fleet.square - fleet.count * common * common;
            score->bias += fleet.bias;
            score->stated_square += fleet.stated_square;
            score->covered += fleet.covered;
            score->count += fleet.count;
        }
    }
    print("cars that change, each as one car", as_one);
    print("cars that change, told apart", apart);
    std::printf("changes found: %d of %d, false: %d\n", found_changes, 2 * fleets, false_changes);
    EXPECT_EQ(found_changes, 2 * fleets);
    EXPECT_LE(false_changes, 1);
    EXPECT_LT(apart.square, as_one.square);
}

TEST(FleetFusion, DoesNotLagBehindATrend) {
    const Road worsening = [](std::size_t, double years) { return 2000 + 100 * years; };
    for (const double years : {1.0, 2.0, 4.0}) {
        for (const double share : {0.15, 1.0}) {
            const Fleet fleet{.years = years, .share = share};
            double lag_um = 0, trend = 0, stated = 0, count = 0;
            for (unsigned seed = 1; seed <= 20; ++seed) {
                for (const auto& passes : driven(fleet, worsening, 10, seed)) {
                    const auto state = fuse(passes, components_of(fleet));
                    lag_um += worsening(0, years_of(*state.last_seen_ms)) - state.iri_um;
                    trend += state.trend_um_per_year.value_or(0);
                    stated += state.trend_sd_um_per_year.value_or(0);
                    ++count;
                }
            }
            std::printf(
                "+0.1 mm/m a year over %.0f years, %3.0f passes: lag %+.3f mm/m, trend %.3f "
                "+- %.3f\n",
                years,
                200 * share,
                lag_um / count / 1000,
                trend / count / 1000,
                stated / count / 1000);
            EXPECT_LT(lag_um / count, 50);
            if (years > 1) {
                EXPECT_NEAR(trend / count, 100, 20); // 200 segments of 20 fleets
            }
        }
    }
}

} // namespace
} // namespace macadam
