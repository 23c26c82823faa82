#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite.hpp"
#include "storage/store_upkeep.hpp"

#include <cstdint>

namespace macadam {

/// From which trips cars are calibrated.
enum class CalibrationBasis {
    all,  ///< that there are
    same, ///< as the last time, of those that are left
};

/// How the cars of a store read, from the passes of its trips; nothing is written.
CalibrationReport find_calibration(Database& database,
                                   std::int64_t segments_in_strip,
                                   CalibrationBasis basis,
                                   const Progress& progress);

/// Begins a generation with these rules and marks all that has passes to be fused by them. Within
/// the caller's transaction.
void take_calibration(Database& database,
                      const CalibrationReport& calibration,
                      CalibrationBasis basis);

} // namespace macadam
