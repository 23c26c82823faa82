#pragma once

#include "mapping/fusion/fleet/fleet_calibration.hpp"
#include "mapping/fusion/fleet/level_shift.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Settings of the search for cars that change.
struct ChangeSearch {
    double false_share = 0.01; ///< expected share of false changes among those found, at most
    double min_level = 0.03;   ///< smaller changes of level are left: trips differ by as much
    double min_scatter = 1.5;  ///< smaller ratios of scatter, after over before, are left
    int max_rounds = 4;        ///< the rest is found by the next calibration
};

/// Readings of a car on one day relative to those of the other cars at the same positions and about
/// the same time.
struct CarDay {
    std::int64_t utc_ms;     ///< start of its first trip
    SeriesPoint level;       ///< logarithm of the ratio
    SeriesPoint log_scatter; ///< of the passes about their median
    std::size_t readings;
};

/// Trips of a fleet, by the number that its readings carry.
struct FleetTrips {
    std::vector<std::optional<std::int64_t>>
        utc_ms;                     ///< start of each trip; `std::nullopt`: unknown
    std::vector<std::uint32_t> car; ///< of each trip: its car, whatever period of it
};

/// Returns the days of each car of `calibration` (a period of a car counts as a car), in order.
///
/// The reference at a place is the mean of the calibrated logarithms of all other cars there,
/// weighted by exp(-|time between| / 60 days): a road that was resurfaced and a season are common
/// to all cars. Places without three cars are left out, since of two that disagree neither is known
/// to have changed. Neighbouring segments are not independent; the level is the median of means
/// over 25 readings (500 m), and its variance that of such means in addition to the trips' own.
///
/// \param readings  in the order of places.
std::vector<std::vector<CarDay>> car_days(const std::vector<FleetReading>& readings,
                                          const FleetTrips& trips,
                                          const FleetCalibration& calibration);

/// Change of one car of a calibration.
struct FoundChange {
    std::uint32_t car;
    std::int64_t utc_ms;             ///< start of the first trip after it
    std::optional<LevelShift> level; ///< of the logarithm of what it reads
    std::optional<LevelShift> log_scatter;
};

/// Finds the cars that changed, in the order of their numbers, at most one change of each.
///
/// All series of the fleet are tested together by the procedure of Y. Benjamini and Y. Hochberg
/// ("Controlling the false discovery rate", Journal of the Royal Statistical Society B 57 (1995),
/// pp. 289-300): if no car changed, the probability of any false alarm is at most
/// `search.false_share`, however many cars and trips there are.
///
/// A car that changes also moves what others are compared with, by less than its own change; so
/// only the largest changes are returned. Split these cars, calibrate, and search again for others.
std::vector<FoundChange> find_car_changes(const std::vector<std::vector<CarDay>>& days,
                                          const ChangeSearch& search,
                                          std::size_t min_readings);

} // namespace macadam
