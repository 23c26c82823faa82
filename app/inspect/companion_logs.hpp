#pragma once

#include "app/inspect/inspection.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Logs of another program that hold one trip together: accelerations in the first, positions in
/// the second, recorded at the same time.
struct CompanionLogs {
    const Inspection* motion;
    const Inspection* positions;
};

/// Finds the first two such logs: files of one folder whose dates overlap, or that are as long if
/// neither has a date.
std::optional<CompanionLogs> companions_in(const std::vector<Inspection>& logs);

/// Mapping that reads both files as one trip, as TOML.
std::string mapping_of(const CompanionLogs& logs);

} // namespace macadam
