#pragma once

#include "storage/store/records/maintenance_records.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Totals of the trips of one car, for one vehicle model and one method.
struct VehicleUse {
    std::string vehicle; ///< pseudonym
    std::string vehicle_model;
    std::string method;
    std::size_t trips = 0;
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    double km = 0; ///< driven
    double matched_km = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
};

/// Reference survey in the database.
struct SurveyUse {
    std::string name;
    std::string file_name;
    std::string sha256;
    std::optional<std::int64_t> utc_ms; ///< day of the measurement
    double relative_sd = 0;             ///< stated accuracy
    double row_m = 0;                   ///< median length of its rows
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
    std::size_t passes = 0; ///< of segments
    double km = 0;          ///< of these segments
    double alone_km = 0;    ///< of these, without a pass of any car
};

struct ClassLength {
    std::string name;
    double km;
};

/// Driven length of one OSM highway class in one roughness class.
struct RoadClassLength {
    std::string highway; ///< "" if the map has none
    std::string class_name;
    double km;
};

/// Totals of the trips that began on one day, UTC.
struct DailyUsage {
    std::string day; ///< "2026-03-01"
    std::size_t trips;
    std::size_t passes;
};

/// Times of the first and the last dated pass; `std::nullopt` if none is dated.
struct ObservedPeriod {
    std::optional<std::int64_t> first_ms;
    std::optional<std::int64_t> last_ms;
};

/// Use of a database by its cars.
struct StoreUsage {
    /// Pseudonyms in the order of their first appearance: by the start of their first dated trip,
    /// then by the smallest hash of their trips. The order does not depend on the key. "unknown"
    /// is last.
    std::vector<std::string> cars;
    std::vector<VehicleUse> vehicles{};           ///< in the order of (cars, model, method)
    std::vector<CalibratedCar> calibrated_cars{}; ///< in the order of cars
    std::vector<DailyUsage> days{};               ///< with dated trips, in order
    /// Counts of log rows that were not used, by reason; trips of version 0.1 have none.
    std::map<std::string, std::size_t> row_reasons{};
    /// Lengths with each direction counted, in the order of (highway, class from smooth to rough).
    std::vector<RoadClassLength> road_classes{};
};

} // namespace macadam
