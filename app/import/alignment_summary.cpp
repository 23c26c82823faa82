#include "app/import/alignment_summary.hpp"

#include <fmt/format.h>

namespace macadam {

std::string alignment_summary_text(const AlignmentSummary& laid) {
    if (laid.found == 0 && laid.beyond_reach == 0) {
        return "";
    }
    auto words = fmt::format("{} of {} drives over strips laid on others", laid.found, laid.drives);
    if (laid.found > 0) {
        words +=
            fmt::format(": {:.2f} m in the middle, {:.1f} % by more than {:g} m",
                        laid.middle_lag_cm / 100.0,
                        100 * static_cast<double>(laid.moved_far) / static_cast<double>(laid.found),
                        far_lag_m);
    }
    if (laid.beyond_reach > 0) {
        words += fmt::format("; {} {} beyond {:g} m and stay{}",
                             laid.beyond_reach,
                             laid.beyond_reach == 1 ? "fits" : "fit",
                             trace_margin_m,
                             laid.beyond_reach == 1 ? "s" : "");
    }
    return words;
}

} // namespace macadam
