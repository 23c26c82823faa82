#pragma once

#include "mapping/fusion/car_changes.hpp"
#include "mapping/fusion/fleet_calibration.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Change of a car at the beginning of a period, relative to the period before.
struct CarChange {
    double level = 0;    ///< of what it reads: 0.14 = 14 % more
    double level_sd = 0; ///< 0: its level did not change significantly
    double scatter = 1;  ///< ratio of the scatter of its passes; 1: not significantly changed
    friend bool operator==(const CarChange&, const CarChange&) = default;
};

/// Period of a car between two changes. Its passes count as those of a car of its own.
struct CarPeriod {
    std::optional<std::int64_t> from_ms; ///< start of its first trip; `std::nullopt`: the first
    std::optional<CarChange> change;     ///< at its beginning; `std::nullopt`: the first
    std::optional<CarCalibration> calibration; ///< `std::nullopt`: too few shared places
    std::size_t shared = 0;                    ///< readings at shared places
    friend bool operator==(const CarPeriod&, const CarPeriod&) = default;
};

/// Index of the period at a time. Undated passes of a car that changed belong to no period:
/// periods.size().
template <typename Periods>
std::size_t period_at(const Periods& periods, const std::optional<std::int64_t>& utc_ms) {
    if (!utc_ms && periods.size() > 1) {
        return periods.size();
    }
    std::size_t period = 0;
    while (utc_ms && period + 1 < periods.size() && *periods[period + 1].from_ms <= *utc_ms) {
        ++period;
    }
    return period;
}

struct ChangingFleet {
    FleetCalibration parts; ///< of cars as they are told apart here: periods, undated trips
    std::vector<std::vector<CarPeriod>> cars; ///< periods of each car, at least one
};

/// Calibrates a fleet (calibrate_fleet) in which cars may change: finds the changes
/// (find_car_changes), treats the periods between them as cars, and repeats until no further change
/// is found. The passes of a car, or a period, that scatters at least 1.5 times as much as the
/// others have an sd that is larger by its own factor.
///
/// \param readings   in the order of places.
/// \param known      as for calibrate_fleet, of each car
/// \param stated_sd  as for calibrate_fleet, of each car
ChangingFleet calibrate_changing_fleet(std::vector<FleetReading> readings,
                                       const FleetTrips& trips,
                                       const std::vector<std::optional<double>>& known,
                                       const FleetPrior& prior,
                                       const std::vector<double>& stated_sd = {},
                                       const ChangeSearch& search = {});

} // namespace macadam
