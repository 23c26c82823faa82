#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/fusion_settings.hpp"
#include "storage/store/privacy/car_order.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/utc.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace macadam {
namespace {

using CarIndex = std::map<std::string, std::size_t>; ///< index of each car in the order of cars

std::vector<VehicleUse> vehicles_in(Database& database, const CarIndex& places) {
    auto select = database.prepare(
        "SELECT vehicle.pseudonym, vehicle_model, method, count(*), count(*) - count(t0_utc_ms),"
        " sum((SELECT count(*) FROM pass WHERE pass.trip = trip.id)), sum(distance_mm),"
        " sum(matched_mm), sum(rows_read), sum(rows_used)"
        " FROM trip JOIN vehicle ON vehicle.id = trip.vehicle GROUP BY 1, 2, 3 ORDER BY 1, 2, 3");
    const auto number = [&](int column) {
        return static_cast<std::size_t>(select.integer(column));
    };
    std::vector<VehicleUse> uses;
    while (select.step()) {
        uses.push_back({.vehicle = select.text(0),
                        .vehicle_model = select.text(1),
                        .method = select.text(2),
                        .trips = number(3),
                        .undated_trips = number(4),
                        .passes = number(5),
                        .km = static_cast<double>(select.integer(6)) / 1e6,
                        .matched_km = static_cast<double>(select.integer(7)) / 1e6,
                        .rows_read = number(8),
                        .rows_used = number(9)});
    }
    std::ranges::stable_sort(uses, {}, [&](const auto& use) { return places.at(use.vehicle); });
    return uses;
}

std::vector<CalibratedCar> calibrated_cars_in(Database& database, const CarIndex& places) {
    const auto records = read_calibrations(database);
    auto select = database.prepare("SELECT id, pseudonym FROM vehicle");
    std::vector<CalibratedCar> cars;
    while (select.step()) {
        if (const auto found = records.find(select.integer(0)); found != records.end()) {
            const auto& [calibration, trips, passes, periods] = found->second;
            cars.push_back({found->first,
                            select.text(1),
                            static_cast<std::size_t>(trips),
                            static_cast<std::size_t>(passes),
                            calibration,
                            periods});
        }
    }
    std::ranges::sort(cars, {}, [&](const auto& car) { return places.at(car.vehicle); });
    return cars;
}

std::map<std::string, std::size_t> row_reasons_in(Database& database) {
    auto select = database.prepare("SELECT reason, sum(rows) FROM row_reason WHERE trip NOT IN"
                                   " (SELECT id FROM trip WHERE reference_ppm IS NOT NULL)"
                                   " GROUP BY reason");
    std::map<std::string, std::size_t> reasons;
    while (select.step()) {
        reasons[select.text(0)] = static_cast<std::size_t>(select.integer(1));
    }
    return reasons;
}

std::vector<RoadClassLength> road_classes_in(Database& database, const ClassTable& classes) {
    auto select = database.prepare(
        "SELECT way.highway, state.class, sum(segment.to_m - segment.from_m) / 1000"
        " FROM segment_state AS state CROSS JOIN segment ON segment.fid = state.fid"
        " CROSS JOIN way ON way.way_id = segment.way_id GROUP BY 1, 2");
    std::map<std::string, std::map<std::string, double>> km_by_highway;
    while (select.step()) {
        km_by_highway[select.text(0)][select.text(1)] += select.real(2);
    }
    std::vector<RoadClassLength> lengths;
    for (auto& [highway, km_by_class] : km_by_highway) {
        for (const auto& roughness : classes.classes) {
            const std::string name{roughness.name};
            lengths.push_back({highway, name, km_by_class[name]});
        }
    }
    return lengths;
}

std::vector<DailyUsage> days_in(Database& database) {
    auto select = database.prepare(
        "SELECT t0_utc_ms, (SELECT count(*) FROM pass WHERE pass.trip = trip.id) FROM trip"
        " WHERE t0_utc_ms IS NOT NULL AND reference_ppm IS NULL");
    std::map<std::string, DailyUsage> days;
    while (select.step()) {
        if (const auto utc_ms = known_utc_ms(select, 0)) {
            auto& day = days[utc_day(*utc_ms)];
            ++day.trips;
            day.passes += static_cast<std::size_t>(select.integer(1));
        }
    }
    std::vector<DailyUsage> uses;
    for (auto& [day, use] : days) {
        uses.push_back({day, use.trips, use.passes});
    }
    return uses;
}

} // namespace

StoreUsage StoreReader::usage() const {
    auto& database = store_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    StoreUsage usage{.cars = read_cars(database)};
    const auto places = places_of_cars(usage.cars);
    usage.vehicles = vehicles_in(database, places);
    usage.calibrated_cars = calibrated_cars_in(database, places);
    usage.days = days_in(database);
    usage.row_reasons = row_reasons_in(database);
    usage.road_classes = road_classes_in(database, store_->classes());
    return usage;
}

std::map<SegmentKey, double> StoreReader::mean_speeds_kmh() const {
    constexpr double kmh_of_mmps = 3.6e-3;
    auto select = store_->database.prepare(
        "SELECT way_id, direction, seq, mean FROM (SELECT pass.segment, avg(speed_mmps) AS mean"
        " FROM pass CROSS JOIN trip ON trip.id = pass.trip"
        " WHERE trip.reference_ppm IS NULL AND speed_mmps > 0 GROUP BY pass.segment) AS driven"
        " CROSS JOIN segment ON segment.fid = driven.segment");
    std::map<SegmentKey, double> speeds_kmh;
    while (select.step()) {
        speeds_kmh[key_in(select, 0)] = kmh_of_mmps * select.real(3);
    }
    return speeds_kmh;
}

} // namespace macadam
