#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/schema/maintenance_records.hpp"

#include <cstdint>

namespace macadam {

/// Trips from which cars are calibrated.
enum class CalibrationBasis {
    all,  ///< all trips
    same, ///< those of the last calibration that still exist
};

/// Calibrates the cars of a database from the passes of their trips, without writing.
CalibrationReport find_calibration(Database& database,
                                   std::int64_t segments_per_chunk,
                                   CalibrationBasis basis,
                                   const Progress& progress);

/// Drops the tables that shadow the rules, if they exist.
inline constexpr const char* drop_shadow_calibration =
    "DROP TABLE IF EXISTS temp.calibration; DROP TABLE IF EXISTS temp.calibration_period;"
    "DROP TABLE IF EXISTS temp.fusion_setting;";

/// Shadows the tables of calibrations and `fusion_setting` with these rules for this connection, so
/// that later fusion uses them.
void build_shadow_calibration(Database& database, const CalibrationReport& calibration);

/// Begins a generation with these rules, within the caller's transaction.
void take_calibration(Database& database, const CalibrationReport& calibration);

} // namespace macadam
