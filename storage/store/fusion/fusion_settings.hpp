#pragma once

#include "mapping/fusion/fusion.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <unordered_map>

namespace macadam {

// By what rules the passes of a store are fused; they stay as they are for a generation.

/// The shipped components where the store has none of its own.
FusionConfig read_fusion_config(Database& database);

/// Rounded to whole millionths and um/m.
void write_fusion_config(Database& database, const FusionConfig& config);

/// What is known of a car beside its calibration.
struct CarRecord {
    CarCalibration calibration; ///< rounded to whole millionths and um/m
    std::int64_t trips;         ///< that it was found from
    std::int64_t passes;
};
using CarRecords = std::unordered_map<std::int64_t, CarRecord>; ///< by row of table vehicle

CarRecords read_calibrations(Database& database);

/// In place of all that there were.
void write_calibrations(Database& database, const CarRecords& cars);

/// From when on passes speak of segments as they are now: older ones, and undated ones, are of a
/// road that is no more.
class ValidFrom {
public:
    explicit ValidFrom(Database& database);

    /// By row of table segment: those in [first, past) that have such a day, ms since 1970 UTC.
    std::unordered_map<std::int64_t, std::int64_t> of(std::int64_t first, std::int64_t past);

private:
    Statement select_;
};

} // namespace macadam
