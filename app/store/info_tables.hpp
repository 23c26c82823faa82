#pragma once

#include "storage/store/road_store.hpp"
#include "storage/text/json.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Of one class of road: all of it on the map, and what was driven, each direction counted.
struct RoadClassInfo {
    std::string highway;
    double network_km = 0;
    double km = 0;
    std::vector<ClassLength> classes; ///< from smooth to rough
};

/// What one car gave, whatever the models and methods.
struct CarInfo {
    std::string vehicle;    ///< pseudonym
    std::size_t number = 0; ///< by which reports call it, from 1; 0: trips that name no car
    std::size_t trips = 0;
    std::size_t passes = 0;
    double share = 0; ///< of all passes
    double km = 0;
    std::optional<CarCalibration> calibration{}; ///< nothing: not calibrated
};

/// What `info` says of a store beyond its sums.
struct InfoTables {
    std::vector<RoadClassInfo> road_classes; ///< most of the network first
    std::vector<CarInfo> cars;               ///< most passes first
    std::vector<DailyUsage> days;
};
InfoTables info_tables(const RoadStore& store);

/// The days added up, by "2026-03".
std::map<std::string, DailyUsage> months_of(const std::vector<DailyUsage>& days);

std::string text_of(const InfoTables& tables);
void add_to(JsonObject& object, const InfoTables& tables);

} // namespace macadam
