#pragma once

#include "mapping/alignment.hpp"

#include <string>

namespace macadam {

/// "980 of 1200 drives over strips laid on others: 0.80 m in the middle, 4.2 % by more than 2 m; 3
/// fit beyond 10 m and stay". "" if no drive has anything in common with others.
std::string laid_words(const LaySummary& laid);

} // namespace macadam
