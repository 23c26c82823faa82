#include "app/import/alignment_summary.hpp"

#include <fmt/format.h>

namespace macadam {

std::string alignment_summary_text(const AlignmentSummary& alignment) {
    if (alignment.found == 0 && alignment.beyond_reach == 0) {
        return "";
    }
    auto words =
        fmt::format("{} of {} passes aligned to others", alignment.found, alignment.drives);
    if (alignment.found > 0) {
        words += fmt::format(" (median shift {:.2f} m, {:.1f} % by more than {:g} m)",
                             alignment.middle_lag_cm / 100.0,
                             100 * static_cast<double>(alignment.moved_far) /
                                 static_cast<double>(alignment.found),
                             far_lag_m);
    }
    if (alignment.beyond_reach > 0) {
        words += fmt::format("; {} needed more than {:g} m and {} left as {}",
                             alignment.beyond_reach,
                             trace_margin_m,
                             alignment.beyond_reach == 1 ? "was" : "were",
                             alignment.beyond_reach == 1 ? "it was" : "they were");
    }
    return words;
}

} // namespace macadam
