#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>
#include <optional>

namespace macadam {

/// One interval of road in a survey with other instruments, such as a laser. The rows of a survey
/// are in driving order.
struct SurveyRow {
    std::size_t line = 0;             ///< line number in the file
    GeoPoint at{};                    ///< midpoint of the interval
    std::optional<double> length_m{}; ///< 0.1 to 2000; `std::nullopt`: half-way to both neighbours
    std::optional<double> iri_mm_per_m{}; ///< of unspecified kind
    std::optional<double> left_mm_per_m{};
    std::optional<double> right_mm_per_m{};
    std::optional<double> mri_mm_per_m{}; ///< mean of left and right
    std::optional<double> hri_mm_per_m{}; ///< of the mean profile
};

} // namespace macadam
