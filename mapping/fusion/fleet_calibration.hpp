#pragma once

#include "mapping/fusion/fusion.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// What one pass read at a place: a segment within a time in which its road is taken for the same.
struct FleetReading {
    std::uint32_t place;
    std::uint32_t car;
    std::uint32_t trip; ///< of that car
    double read_um;     ///< > 0
};

/// What is known before anything is read. Relative: of the level of the place.
struct FleetPrior {
    double gain_sd = 0.15;       ///< of cars about 1
    double offset_sd_um = 100;   ///< of cars about 0
    double car_sd = 0.08;        ///< how far cars are off each other, as sure as 4 cars make it
    double trip_sd = 0.02;       ///< as sure as 5 trips make it
    double rest_sd = 0.07746;    ///< of a pass
    double rest_sd_um = 50;      ///< and beside it; taken as it is
    double min_car_sd = 0.01;    ///< what no number of passes does away with: speed, tyres, weather
    std::size_t min_shared = 50; ///< places that a car shares with others, to be calibrated
};

struct FleetCalibration {
    std::vector<std::optional<CarCalibration>> cars; ///< nothing: too little is shared with others
    std::vector<std::size_t> shared;                 ///< readings of each car at shared places
    double car_sd;                                   ///< how far cars are off each other, relative
    double trip_sd;     ///< how far trips of a car are off each other, relative
    double rest_sd;     ///< of a pass, relative, beside FleetPrior::rest_sd_um
    double anchor_sd;   ///< of all cars together, relative
    std::size_t places; ///< where two or more cars passed
};

/// How each car reads, from what others read at the same places:
///
///     read / level = 1 + gain error of the car + error of the trip + offset of the car / level +
///     rest
///
/// Levels, cars and trips are fitted in turn until they agree; what is left has Student's t with 4
/// degrees of freedom, so that a place that changed or a broken pass hardly counts. Trips are
/// random, cars have the prior's variance. Then the spread of trips and passes is taken from what
/// is left, and all is fitted again.
///
/// Cars alone do not tell what is right: their mean (robust, as a broken one must not move the
/// others) is taken for it, and `anchor_sd` states how far that may be off. Where a car is known,
/// as a laser survey is, all are held against it.
///
/// \param readings  in the order of places.
/// \param known     for each car: the relative sd of what is taken to be right; nothing for cars.
FleetCalibration calibrate_fleet(const std::vector<FleetReading>& readings,
                                 const std::vector<std::optional<double>>& known,
                                 const FleetPrior& prior);

} // namespace macadam
