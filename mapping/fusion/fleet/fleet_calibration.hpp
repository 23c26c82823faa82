#pragma once

#include "mapping/fusion/fusion.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Reading of one pass at a place: a segment within a period over which its road counts as
/// unchanged.
struct FleetReading {
    std::uint32_t place;
    std::uint32_t car;
    std::uint32_t trip; ///< number among all trips; each belongs to one car
    double read_um;     ///< > 0
};

/// Prior of the calibration. Relative values refer to the level of the place.
struct FleetPrior {
    double gain_sd = 0.15;     ///< of cars about 1
    double offset_sd_um = 100; ///< of cars about 0
    double car_sd = 0.08;      ///< spread of cars, with the certainty of 4 cars
    double trip_sd = 0.02;     ///< spread of trips, with the certainty of 5 trips
    double rest_sd = 0.07746;  ///< of a pass
    double rest_sd_um = 50;    ///< absolute part of it; fixed
    double common_sd = 0.03;   ///< of the mean of cars of any number: the method (bias of fleets in
                               ///< docs/method/accuracy.md)
    double min_car_sd = 0.01;  ///< floor that no number of passes reduces: speed, tyres, weather
    std::size_t min_shared = 50; ///< shared places a car needs to be calibrated
};

struct FleetCalibration {
    std::vector<std::optional<CarCalibration>> cars; ///< `std::nullopt`: too few shared places
    std::vector<bool> is_known;                      ///< sources taken as correct
    std::vector<std::size_t> shared;                 ///< readings of each car at shared places
    std::vector<double> scatter; ///< of each car's passes, over that of all; 1 where unknown
    double car_sd;               ///< spread between cars, relative
    double trip_sd;              ///< spread between trips of a car, relative
    double rest_sd;              ///< of a pass, relative, in addition to FleetPrior::rest_sd_um
    double anchor_sd;            ///< common to all cars, relative
    double middle_um;            ///< median level of the shared places

    /// Relative variance of what all cars misread locally, seen where known sources passed.
    double local_error_variance;
    double local_error_places; ///< number of independent places from which it is known
    std::size_t places;        ///< passed by two or more cars
};

/// Calibrates each car from what others read at the same places:
///     read / level = 1 + gain error of the car + error of the trip + offset of the car / level +
///     rest
/// Levels, cars and trips are fitted in turn until they converge. Residuals have Student's t
/// distribution with 4 degrees of freedom, so that a changed place or a broken pass hardly counts.
/// Trips are random effects; cars have the variance of the prior. The spread of trips and passes is
/// then estimated from the residuals, and everything is fitted again.
///
/// Cars alone do not reveal the true level: their robust mean is taken for it, each weighted by the
/// uncertainty that its readings state, so that a car whose file is good counts more than one that
/// is taken for an average car, and one broken car cannot move the others. `anchor_sd` states how
/// far the mean may be off. If a source is known, such as a laser survey, the level is the mean of
/// the source and of the cars, each weighted by its variance. That of the source is its own and
/// that of what the cars misread along a road, from blocks of 25 places: a survey of two roads says
/// less about the fleet than one of twenty. A mean of cars that contradicts the source counts less,
/// and not at all from 3 standard deviations on.
///
/// \param readings   in the order of places.
/// \param known      for each car: relative sd of a source taken as correct; `std::nullopt` for
///                   cars.
/// \param stated_sd  for each car: relative sd that its readings state; only their ratios count.
///                   Empty: all are alike.
/// \param scatter    for each car: factor on the sd of its passes. Empty: all are 1.
/// \param share      for each car: its share of the weight that one car has in the mean, > 0 and
///                   <= 1; less than 1 for a period of a car. Empty: all are 1.
FleetCalibration calibrate_fleet(const std::vector<FleetReading>& readings,
                                 const std::vector<std::optional<double>>& known,
                                 const FleetPrior& prior,
                                 const std::vector<double>& stated_sd = {},
                                 const std::vector<double>& scatter = {},
                                 const std::vector<double>& share = {});

} // namespace macadam
