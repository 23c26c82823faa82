#pragma once

#include "storage/store/reader/store_reader.hpp"
#include "storage/text/unit_system.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Length of one class of road on the map and driven, counting each direction.
struct RoadClassInfo {
    std::string highway;
    double network_km = 0;
    double km = 0;
    std::vector<ClassLength> classes; ///< from smooth to rough
};

/// Contribution of one car, over all models and methods.
struct CarInfo {
    std::string vehicle;    ///< pseudonym
    std::size_t number = 0; ///< number in reports, from 1; 0: trips that name no car
    std::size_t trips = 0;
    std::size_t passes = 0;
    double share = 0; ///< fraction of all passes
    double km = 0;
    std::optional<CarCalibration> calibration{}; ///< `std::nullopt`: not calibrated
    std::vector<CarPeriod> periods{};            ///< as in CalibratedCar
};

/// Tables of `info` besides the totals.
struct InfoTables {
    std::vector<RoadClassInfo> road_classes; ///< longest network first
    std::vector<CarInfo> cars;               ///< most passes first
    std::vector<DailyUsage> days;
};
InfoTables info_tables(const StoreReader& store);

/// Sums the days by month, such as "2026-03".
std::vector<DailyUsage> months_of(const std::vector<DailyUsage>& days);

/// Formats lengths by class as JSON, with their shares of `km`.
std::string
class_lengths_json(const std::vector<ClassLength>& lengths, double km, UnitSystem units);

/// \name Columns of these tables
/// @{
Columns<RoadClassInfo> road_class_columns(UnitSystem units);
Columns<CarInfo> car_columns(UnitSystem units = UnitSystem::si);
/// \param period  heading: "day" or "month"
Columns<DailyUsage> usage_columns(std::string_view period);
/// Columns of lengths by class, with their shares of `km`.
Columns<ClassLength> class_columns(double km);
/// @}

std::string text_of(const InfoTables& tables, UnitSystem units = UnitSystem::si);
void add_to(JsonObject& object, const InfoTables& tables, UnitSystem units);

} // namespace macadam
