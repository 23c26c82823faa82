#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/shadow_update.hpp"
#include "storage/store/fusion/store_calibration.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {
namespace {

std::ptrdiff_t calibrated_in(const CalibrationReport& report) {
    return std::ranges::count_if(report.cars,
                                 [](const auto& car) { return car.calibration.has_value(); });
}

} // namespace

CalibrationReport StoreMaintenance::calibrate(const Progress& progress) {
    auto& database = store_->database;
    const auto in_chunk = store_->segments_per_chunk();
    std::optional<CalibrationReport> report;
    std::int64_t last_trip = 0; // last one in the basis of the calibration
    const auto build_shadow = [&]() -> std::optional<std::vector<std::int64_t>> {
        last_trip = moment_of(database).last_trip;
        report = find_calibration(database, in_chunk, CalibrationBasis::all, progress);
        if (calibrated_in(*report) == 0) {
            return std::nullopt;
        }
        build_shadow_calibration(database, *report);
        return driven_chunks(database);
    };
    const auto apply = [&] {
        take_calibration(database, *report);
        database.prepare("UPDATE trip SET calibrates = 1 WHERE NOT calibrates AND id <= ?")
            .run(last_trip);
        report->generation = read_generation(database);
        return add_audit(
            database,
            "calibrate",
            fmt::format("cars: {} of {}", calibrated_in(*report), report->cars.size()));
    };
    apply_maintenance(database,
                      in_chunk,
                      store_->classes(),
                      {build_shadow, drop_shadow_calibration, apply},
                      progress);
    store_->written(progress);
    return *report;
}

} // namespace macadam
