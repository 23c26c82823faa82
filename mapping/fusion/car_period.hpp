#pragma once

#include "mapping/fusion/fusion.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

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
inline std::size_t period_at(std::span<const CarPeriod> periods,
                             const std::optional<std::int64_t>& utc_ms) {
    if (!utc_ms && periods.size() > 1) {
        return periods.size();
    }
    std::size_t period = 0;
    while (period + 1 < periods.size() && periods[period + 1].from_ms <= utc_ms) {
        ++period;
    }
    return period;
}

} // namespace macadam
