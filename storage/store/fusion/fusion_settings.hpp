#pragma once

#include "mapping/fusion/car_period.hpp"
#include "mapping/fusion/fusion.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace macadam {

// Fusion rules of a database, constant within a generation.

/// Reads the rules; the default components if the database has none of its own.
FusionConfig read_fusion_config(Database& database);

/// Writes the rules, rounded to whole millionths and um/m.
void write_fusion_config(Database& database, const FusionConfig& config);

/// Calibration of a car and its basis.
struct CarRecord {
    CarCalibration calibration; ///< rounded to whole millionths and um/m
    std::int64_t trips;         ///< used for the calibration
    std::int64_t passes;
    std::vector<CarPeriod> periods{}; ///< of a car that changed or whose passes scatter: oldest
                                      ///< first, `calibration` is that of the last calibrated one;
                                      ///< else empty
};
using CarRecords = std::unordered_map<std::int64_t, CarRecord>; ///< by row of table vehicle

CarRecords read_calibrations(Database& database);

/// Replaces all calibrations and their periods.
void write_calibrations(Database& database, const CarRecords& cars);

/// Deletes the calibrations of cars that have no trips.
void erase_calibrations_without_trips(Database& database);

/// Dates from which passes over segments count; older and undated passes belong to a former
/// surface.
class ValidFrom {
public:
    explicit ValidFrom(Database& database);

    /// Dates of the segments with rows in [first, past) that have one, in ms since 1970 UTC, by row
    /// of table segment.
    std::unordered_map<std::int64_t, std::int64_t> of(std::int64_t first, std::int64_t past);

private:
    Statement select_;
};

} // namespace macadam
