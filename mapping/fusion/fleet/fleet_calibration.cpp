#include "mapping/fusion/fleet/fleet_calibration.hpp"

#include "estimator/common/statistics.hpp"
#include "mapping/fusion/fleet/fleet_fit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace macadam {
namespace {

constexpr int max_rounds = 400;
constexpr int first_spread_round = 8; // by then the fit is nearly converged
constexpr int last_spread_round = 64;
constexpr double settled = 1e-8; // relative; far below the stored resolution of 1e-6

/// Selects readings at places passed by at least two cars; others carry no information about a car.
/// Places are renumbered from 0 without gaps.
std::vector<FleetReading> shared_readings(const std::vector<FleetReading>& readings) {
    std::vector<FleetReading> shared;
    std::uint32_t places = 0;
    for (std::size_t i = 0, past = 0; i < readings.size(); i = past) {
        bool is_shared = false;
        for (past = i; past < readings.size() && readings[past].place == readings[i].place;
             ++past) {
            is_shared = is_shared || readings[past].car != readings[i].car;
        }
        for (auto j = i; is_shared && j < past; ++j) {
            shared.push_back(readings[j]);
            shared.back().place = places;
        }
        places += is_shared ? 1 : 0;
    }
    return shared;
}

/// Counts the distinct places that each car shares with others.
std::vector<std::size_t> shared_places(const std::vector<FleetReading>& readings,
                                       std::size_t cars) {
    std::vector<std::size_t> places(cars, 0);
    std::vector<std::optional<std::uint32_t>> last(cars);
    for (const auto& reading : readings) {
        if (last[reading.car] != reading.place) {
            last[reading.car] = reading.place;
            ++places[reading.car];
        }
    }
    return places;
}

double square(double x) {
    return x * x;
}

/// Returns the weight of each car in the mean that is taken as correct: inverse to the variance
/// that its readings state, 1 for the median car, times its share.
std::vector<double> anchor_weights(const std::vector<std::optional<double>>& known,
                                   const std::vector<double>& stated_sd,
                                   const std::vector<double>& share) {
    std::vector<double> of_cars;
    for (std::size_t car = 0; car < stated_sd.size(); ++car) {
        if (!known[car] && stated_sd[car] > 0) {
            of_cars.push_back(stated_sd[car]);
        }
    }
    const double median_sd = median(std::move(of_cars));
    auto weights = share.empty() ? std::vector<double>(known.size(), 1) : share;
    for (std::size_t car = 0; car < stated_sd.size(); ++car) {
        if (!known[car] && stated_sd[car] > 0) {
            weights[car] *= square(median_sd / stated_sd[car]);
        }
    }
    return weights;
}

} // namespace

FleetCalibration calibrate_fleet(const std::vector<FleetReading>& readings,
                                 const std::vector<std::optional<double>>& known,
                                 const FleetPrior& prior,
                                 const std::vector<double>& stated_sd,
                                 const std::vector<double>& scatter,
                                 const std::vector<double>& share) {
    const auto shared = shared_readings(readings);
    const auto places = shared_places(shared, known.size());
    const auto weights = anchor_weights(known, stated_sd, share);
    FleetFit fit{shared, known, prior, weights, scatter};
    for (int round = 0; round < max_rounds; ++round) {
        const double moved = fit.settle();
        const bool is_spread_round =
            round >= first_spread_round && round <= last_spread_round && (round & (round - 1)) == 0;
        if (is_spread_round) {
            fit.take_spread();
        } else if (moved < settled && round > last_spread_round) {
            break;
        }
    }

    std::vector<bool> counts(known.size());
    for (std::size_t car = 0; car < known.size(); ++car) {
        counts[car] = !known[car] && places[car] >= prior.min_shared;
    }
    FleetCalibration fleet{.cars = std::vector<std::optional<CarCalibration>>(known.size()),
                           .is_known = std::vector<bool>(known.size()),
                           .shared = std::vector<std::size_t>(known.size(), 0),
                           .scatter = fit.scatter_of_cars(),
                           .car_sd = fit.spread_of_cars(counts, 0),
                           .trip_sd = fit.trip_sd,
                           .rest_sd = fit.rest_sd,
                           .anchor_sd = 0,
                           .middle_um = fit.middle_um(),
                           .local_error_variance = 0,
                           .local_error_places = 0,
                           .places = fit.place_count()};
    for (const auto& reading : shared) {
        ++fleet.shared[reading.car];
    }
    for (std::size_t car = 0; car < known.size(); ++car) {
        fleet.is_known[car] = known[car].has_value();
        if (counts[car]) {
            const auto& [gain, offset_um, error, variance] = fit.cars[car];
            fleet.cars[car] =
                CarCalibration{.gain = gain,
                               .offset_um = offset_um,
                               .relative_sd = std::sqrt(variance + square(prior.min_car_sd)),
                               .scatter = scatter.empty() ? 1 : scatter[car]};
        }
    }
    double weight = 0;
    for (std::size_t car = 0; car < known.size(); ++car) {
        weight += counts[car] ? weights[car] : 0;
    }
    fleet.anchor_sd = fit.anchor_sd.value_or(fleet.car_sd / std::sqrt(std::max(1.0, weight)));
    const auto [variance, count] = fit.local_error();
    fleet.local_error_variance = variance;
    fleet.local_error_places = count;
    return fleet;
}

} // namespace macadam
