#pragma once

#include "mapping/fusion/segment_record.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// A named section of road of known roughness, for monitoring the cars. 0 <= from_m < to_m along
/// the way from its first node, in whole millimetres.
struct ControlSection {
    std::string name;
    std::int64_t way_id;
    bool forward;
    double from_m;
    double to_m;
    double iri_mm_per_m;
    double sd_mm_per_m;                 ///< of the known value
    std::optional<std::int64_t> utc_ms; ///< time of measurement
    friend bool operator==(const ControlSection&, const ControlSection&) = default;
};

/// Cuts the segments of its way and direction to the section; only the part inside counts.
std::vector<SegmentRecord> cut_to(const ControlSection& section,
                                  std::vector<SegmentRecord> records);

/// Difference of the cars' reading from the known value at a time; mm/m.
struct ControlReading {
    double years; ///< since an arbitrary epoch
    double off;
    double sd; ///< of the reading, > 0
};

/// Trend of the difference: a line through readings weighted by 1 / sd^2.
struct Drift {
    double per_year; ///< mm/m
    double sd_per_year;
    bool significant; ///< |per_year| > 2 sd_per_year
};

/// Minimum number of readings to distinguish a trend from scatter.
inline constexpr std::size_t min_control_readings = 4;

/// Estimates the trend by weighted least squares. Its sd comes from the scatter about the line, not
/// from the stated sds: a car's constant error is in all its months and is no drift. Student's t
/// widens it for few readings, so that chance exceeds twice the sd in 5 % of steady sections.
///
/// \returns  `std::nullopt` for fewer than min_control_readings, or if all are of one time.
std::optional<Drift> drift_of(std::span<const ControlReading> readings);

/// Returns the 97.5 % quantile of Student's t distribution: 12.71 for 1 degree of freedom, which is
/// the fewest, 4.303 for 2, 1.960 in the limit. Accurate to 0.1 % for whole degrees and from 6 on;
/// in between it is interpolated linearly, which gives too much rather than too little.
double student_t_975(double degrees_of_freedom);

} // namespace macadam
