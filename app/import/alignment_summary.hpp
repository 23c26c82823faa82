#pragma once

#include "mapping/alignment/alignment.hpp"

#include <string>

namespace macadam {

/// "980 of 1200 drives over chunks laid on others: 0.80 m in the middle, 4.2 % by more than 2 m; 3
/// fit beyond 10 m and stay". "" if no drive has anything in common with others.
std::string alignment_summary_text(const AlignmentSummary& laid);

} // namespace macadam
