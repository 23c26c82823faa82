#pragma once

#include "mapping/fusion/segment_record.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// A named stretch of road whose roughness is known from elsewhere, to watch the cars by. 0 <=
/// from_m < to_m along the way from its first node, in whole millimetres.
struct ControlSection {
    std::string name;
    std::int64_t way_id;
    bool forward;
    double from_m;
    double to_m;
    double iri_mm_per_m;
    double sd_mm_per_m;                 ///< of what is known
    std::optional<std::int64_t> utc_ms; ///< when it was measured
    friend bool operator==(const ControlSection&, const ControlSection&) = default;
};

/// The segments of its way and direction cut to the section: what is left of them is what counts.
std::vector<SegmentRecord> cut_to(const ControlSection& section,
                                  std::vector<SegmentRecord> records);

/// What cars read less what is known, at a time; mm/m.
struct ControlReading {
    double years; ///< from any day
    double off;
    double sd; ///< of the reading, > 0
};

/// Whether the difference changes: the line through readings weighted by 1 / sd^2.
struct Drift {
    double per_year; ///< mm/m
    double sd_per_year;
    bool significant; ///< |per_year| > 2 sd_per_year
};

/// How many readings it takes to tell a trend from their scatter.
inline constexpr std::size_t min_control_readings = 4;

/// The trend by weighted least squares. Its sd is of the scatter about the line, not of the stated
/// sds: what a car reads wrong is in all its months and no drift. It is widened by Student's t for
/// few readings, so that beyond twice the sd lies what chance gives in 5 % of steady sections.
///
/// \returns  nothing for fewer than min_control_readings, or if all are of one time.
std::optional<Drift> drift_of(std::span<const ControlReading> readings);

/// The 97.5 % point of Student's t distribution: 4.303 for 2 degrees of freedom, 1.960 for many.
/// Within 0.1 % from 2 on.
double student_t_975(double degrees_of_freedom);

} // namespace macadam
