#pragma once

#include "estimator/common/progress.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace macadam {

/// Unit in which people are told of progress.
struct ProgressUnit {
    std::string name{};    ///< "trip"; "" = per cent
    std::size_t parts = 1; ///< steps of the progress in one unit
};

/// Words of a progress display: "12/120 trips, 4 min left", "45 %, 20 s left", or "12 trips" if the
/// total is unknown (0).
std::string progress_text(const ProgressUnit& unit,
                          std::size_t done,
                          std::size_t whole,
                          std::optional<std::chrono::seconds> left);

/// Returns the progress display of a task on standard error: a bar on a terminal, which disappears
/// when it is full; elsewhere a line every 30 s.
///
/// \param label  "importing"
Progress progress_display(std::string label, ProgressUnit unit, bool on_terminal);

/// Removes the bar from the terminal, if there is one, before other text is written.
void clear_progress_bar();

} // namespace macadam
