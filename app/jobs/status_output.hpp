#pragma once

#include "storage/jobs/work_status.hpp"

#include <cstddef>
#include <string>

namespace macadam {

/// Length of WorkStatus::failed as people see it.
inline constexpr std::size_t max_shown_failures = 20;

/// Formats the state of a queue as lines and tables for people.
std::string status_text(const WorkStatus& status);

/// Formats it as a JSON object.
std::string status_json(const WorkStatus& status);

/// Formats its counts for Prometheus (text format 0.0.4).
std::string status_metrics(const WorkStatus& status);

} // namespace macadam
