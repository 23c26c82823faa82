#include "app/import/alignment_summary.hpp"

#include <fmt/format.h>

namespace macadam {

std::string alignment_summary_text(const AlignmentSummary& alignment, UnitSystem units) {
    if (alignment.found == 0 && alignment.beyond_reach == 0) {
        return "";
    }
    const bool us = units == UnitSystem::us;
    auto words =
        fmt::format("{} of {} passes aligned to others", alignment.found, alignment.drives);
    if (alignment.found > 0) {
        words += fmt::format(" (median shift {:.2f} {}, {:.1f} % by more than {})",
                             alignment.middle_lag_cm / 100.0 * (us ? ft_of_m : 1),
                             us ? "ft" : "m",
                             100 * static_cast<double>(alignment.moved_far) /
                                 static_cast<double>(alignment.found),
                             length_words(far_lag_m, units));
    }
    if (alignment.beyond_reach > 0) {
        words += fmt::format("; {} needed more than {} and {} left as {}",
                             alignment.beyond_reach,
                             length_words(trace_margin_m, units),
                             alignment.beyond_reach == 1 ? "was" : "were",
                             alignment.beyond_reach == 1 ? "it was" : "they were");
    }
    return words;
}

} // namespace macadam
