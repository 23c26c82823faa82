#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/schema/maintenance_records.hpp"

#include <cstdint>

namespace macadam {

/// From which trips cars are calibrated.
enum class CalibrationBasis {
    all,  ///< that there are
    same, ///< as the last time, of those that are left
};

/// How the cars of a store read, from the passes of its trips; nothing is written.
CalibrationReport find_calibration(Database& database,
                                   std::int64_t segments_per_chunk,
                                   CalibrationBasis basis,
                                   const Progress& progress);

/// Puts tables `calibration` and `fusion_setting` with these rules before those of the store, for
/// this connection: what is fused from then on is fused by them.
void build_shadow_calibration(Database& database, const CalibrationReport& calibration);

/// Takes those tables away, also if they are not there.
inline constexpr const char* drop_shadow_calibration =
    "DROP TABLE IF EXISTS temp.calibration; DROP TABLE IF EXISTS temp.fusion_setting;";

/// Begins a generation with these rules. Within the caller's transaction.
void take_calibration(Database& database, const CalibrationReport& calibration);

} // namespace macadam
