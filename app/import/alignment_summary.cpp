#include "app/import/alignment_summary.hpp"

#include <fmt/format.h>

namespace macadam {

std::string alignment_summary_text(const AlignmentSummary& laid) {
    if (laid.found == 0 && laid.beyond_reach == 0) {
        return "";
    }
    auto words = fmt::format("{} of {} passes aligned to others", laid.found, laid.drives);
    if (laid.found > 0) {
        words +=
            fmt::format(" (median shift {:.2f} m, {:.1f} % by more than {:g} m)",
                        laid.middle_lag_cm / 100.0,
                        100 * static_cast<double>(laid.moved_far) / static_cast<double>(laid.found),
                        far_lag_m);
    }
    if (laid.beyond_reach > 0) {
        words += fmt::format("; {} needed more than {:g} m and {} left as {}",
                             laid.beyond_reach,
                             trace_margin_m,
                             laid.beyond_reach == 1 ? "was" : "were",
                             laid.beyond_reach == 1 ? "it was" : "they were");
    }
    return words;
}

} // namespace macadam
