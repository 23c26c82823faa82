#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>
#include <optional>

namespace macadam {

/// What a survey with other instruments, such as a laser, says of one piece of road. The rows of a
/// survey come in the order in which it was driven.
struct SurveyRow {
    std::size_t line = 0;                 ///< of the file
    GeoPoint at{};                        ///< of the middle of the piece
    std::optional<double> length_m{};     ///< 0.1 to 2000; nothing: half-way to both neighbours
    std::optional<double> iri_mm_per_m{}; ///< of a kind that is not told
    std::optional<double> left_mm_per_m{};
    std::optional<double> right_mm_per_m{};
    std::optional<double> mri_mm_per_m{}; ///< mean of left and right
    std::optional<double> hri_mm_per_m{}; ///< of the mean profile
};

} // namespace macadam
