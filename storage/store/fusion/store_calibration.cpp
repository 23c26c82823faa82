#include "storage/store/fusion/store_calibration.hpp"

#include "estimator/common/error.hpp"
#include "mapping/fusion/fleet/changing_fleet.hpp"
#include "storage/store/fusion/chunk_states.hpp"
#include "storage/store/fusion/fusion_settings.hpp"
#include "storage/store/privacy/car_order.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace macadam {
namespace {

// A road counts as unchanged within a year: it gets rougher by some percent, equally for all cars.
constexpr std::int64_t window_ms = 31'557'600'000;
constexpr std::int64_t undated = -1;

// A thousand for each of 10,000 cars, to find changes; they take 1.5 GB.
constexpr std::int64_t max_readings = 12'000'000;

constexpr std::uint8_t unsure = validity::too_slow | validity::start_up | validity::lateral_alone;

struct Car {
    std::int64_t row;
    std::string pseudonym;
    std::size_t trips = 0;
};

/// Cars and surveys with common numbers: first cars, then surveys.
struct Fleet {
    std::vector<Car> cars; ///< by the smallest hash of their trips in the basis
    std::unordered_map<std::int64_t, std::uint32_t> number_of_car;
    struct Trip {
        std::uint32_t number;
        std::uint32_t car; ///< number of the car or survey
    };
    std::unordered_map<std::string, Trip> number_of_trip; ///< of the basis, by hash
    FleetTrips origins;                                   ///< of the trips, by number
    std::unordered_set<std::string> trips;                ///< hashes of the trips
    std::vector<std::optional<double>> known;             ///< relative sd of surveys
    std::int64_t newest_ms = std::numeric_limits<std::int64_t>::min();
};

/// Adds the cars in an order that does not depend on the key, because the last digits of sums
/// depend on the order.
void add_cars(Fleet& fleet, Database& database, CalibrationBasis basis) {
    auto cars = database.prepare(
        "SELECT vehicle.id, pseudonym FROM vehicle LEFT JOIN trip ON trip.vehicle = vehicle.id"
        " AND (?1 OR calibrates) WHERE pseudonym <> 'unknown'"
        " GROUP BY vehicle.id ORDER BY min(sha256)");
    cars.bind(basis == CalibrationBasis::all);
    while (cars.step()) {
        fleet.number_of_car[cars.integer(0)] = static_cast<std::uint32_t>(fleet.cars.size());
        fleet.cars.push_back({cars.integer(0), cars.text(1)});
    }
    fleet.known.resize(fleet.cars.size());
}

/// Collects cars and surveys. Trips without a vehicle_id belong to no car that could be calibrated.
Fleet fleet_of(Database& database, CalibrationBasis basis) {
    Fleet fleet;
    add_cars(fleet, database, basis);
    auto trips = database.prepare("SELECT sha256, vehicle, t0_utc_ms, reference_ppm FROM trip"
                                  " WHERE ?1 OR calibrates ORDER BY sha256");
    trips.bind(basis == CalibrationBasis::all);
    while (trips.step()) {
        const auto number = static_cast<std::uint32_t>(fleet.number_of_trip.size());
        const auto sha256 = trips.text(0);
        if (const auto ppm = trips.known_integer(3)) {
            fleet.number_of_trip[sha256] = {number, static_cast<std::uint32_t>(fleet.known.size())};
            fleet.known.push_back(static_cast<double>(std::max<std::int64_t>(1, *ppm)) / 1e6);
        } else if (const auto car = fleet.number_of_car.find(trips.integer(1));
                   car != fleet.number_of_car.end()) {
            ++fleet.cars[car->second].trips;
            fleet.number_of_trip[sha256] = {number, car->second};
        } else {
            continue;
        }
        fleet.trips.insert(sha256);
        fleet.origins.car.push_back(fleet.number_of_trip.at(sha256).car);
        fleet.origins.utc_ms.push_back(known_utc_ms(trips, 2));
        if (const auto& utc_ms = fleet.origins.utc_ms.back()) {
            fleet.newest_ms = std::max(fleet.newest_ms, *utc_ms);
        }
    }
    return fleet;
}

/// Selects every n-th chunk with passes, if there are too many passes to use all.
std::vector<std::int64_t> sampled_chunks(Database& database, CalibrationBasis basis) {
    const bool of_all = basis == CalibrationBasis::all;
    auto count = database.prepare("SELECT count(*) FROM pass"
                                  " WHERE trip IN (SELECT id FROM trip WHERE ?1 OR calibrates)");
    count.bind(of_all).step();
    const auto step = 1 + (count.integer(0) - 1) / max_readings;
    auto select =
        database.prepare("SELECT DISTINCT segment.strip FROM (SELECT DISTINCT segment FROM pass"
                         " WHERE trip IN (SELECT id FROM trip WHERE ?1 OR calibrates)) AS driven"
                         " CROSS JOIN segment ON segment.fid = driven.segment ORDER BY 1");
    select.bind(of_all);
    std::vector<std::int64_t> chunks;
    for (std::int64_t i = 0; select.step(); ++i) {
        if (i % step == 0) {
            chunks.push_back(select.integer(0));
        }
    }
    return chunks;
}

struct Readings {
    std::vector<FleetReading> all; ///< in the order of places
    double stated_square = 0;      ///< sum of the relative variances stated by passes of cars
    std::size_t of_cars = 0;

    /// Of each car: sum of the relative variances that its passes state, and their number.
    std::vector<std::pair<double, std::size_t>> stated;

    std::vector<double> stated_sd() const {
        std::vector<double> sds;
        for (const auto& [square, passes] : stated) {
            sds.push_back(passes == 0 ? 0 : std::sqrt(square / static_cast<double>(passes)));
        }
        return sds;
    }
};

/// Adds the readings from the passes of a chunk.
void add(Readings& readings,
         const std::vector<ChunkPass>& passes,
         const Fleet& fleet,
         std::uint32_t& places) {
    struct WindowReading {
        std::int64_t fid, window;
        FleetReading reading;
    };
    std::vector<WindowReading> placed;
    for (const auto& [fid, input, from_m, to_m] : passes) {
        if ((input.pass.validity & unsure) != 0 || input.pass.iri_um <= 0) {
            continue;
        }
        const auto window = input.utc_ms && *input.utc_ms <= fleet.newest_ms
                                ? (fleet.newest_ms - *input.utc_ms) / window_ms
                                : undated;
        const auto& [trip, car] = fleet.number_of_trip.at(input.trip_sha256);
        placed.push_back({fid,
                          input.utc_ms ? std::max<std::int64_t>(0, window) : undated,
                          {.place = 0,
                           .car = car,
                           .trip = trip,
                           .read_um = static_cast<double>(input.pass.iri_um)}});
        if (!input.reference) {
            const double variance =
                std::pow(static_cast<double>(input.pass.sd_um) / input.pass.iri_um, 2);
            readings.stated_square += variance;
            ++readings.of_cars;
            readings.stated[car].first += variance;
            ++readings.stated[car].second;
        }
    }
    std::ranges::stable_sort(placed, [](const WindowReading& a, const WindowReading& b) {
        return std::pair{a.fid, a.window} < std::pair{b.fid, b.window};
    });
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (i > 0 &&
            (placed[i].fid != placed[i - 1].fid || placed[i].window != placed[i - 1].window)) {
            ++places;
        }
        placed[i].reading.place = places;
        readings.all.push_back(placed[i].reading);
    }
    places += placed.empty() ? 0 : 1;
}

Readings readings_of(Database& database,
                     std::int64_t segments_per_chunk,
                     const Fleet& fleet,
                     CalibrationBasis basis,
                     const Progress& progress) {
    ChunkFusion states{database};
    const auto chunks = sampled_chunks(database, basis);
    Readings readings;
    readings.stated.resize(fleet.known.size());
    std::uint32_t places = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        if (progress.stop.stop_requested()) {
            throw InputError{fmt::format("{}: interrupted; the database is unchanged",
                                         database.file().string())};
        }
        add(readings, states.readings(chunks[i], segments_per_chunk, fleet.trips), fleet, places);
        progress(i + 1, chunks.size());
    }
    return readings;
}

/// Returns the relative variance of what all cars misread alike: what the surveys show, and what is
/// stated with the certainty of 40 places. In simulated worlds the stated sd is right to 15 %,
/// which a median absolute deviation of some 60 places tells.
double common_variance(const FleetCalibration& found, double stated) {
    constexpr double places_of_prior = 40;
    const double places = found.local_error_places;
    return (places_of_prior * stated + places * found.local_error_variance) /
           (places_of_prior + places);
}

FusionConfig components_of(const FleetCalibration& found, double stated_variance) {
    FusionConfig config;
    config.trip_relative_sd = found.trip_sd;
    config.rest_relative_sd = found.rest_sd;
    config.anchor_relative_sd = found.anchor_sd;
    if (stated_variance > 0) {
        config.car_share = found.car_sd * found.car_sd / stated_variance;
    }
    if (stated_variance > 0 && found.local_error_places > 0) {
        const double stated =
            std::min(config.common_share * stated_variance,
                     config.max_common_relative_sd * config.max_common_relative_sd);
        const double variance = common_variance(found, stated);
        config.max_common_relative_sd = std::sqrt(variance);
        config.common_share = std::clamp(variance / stated_variance, config.common_share, 1.0);
    }
    return config;
}

/// Number of surveys that passed places within a year of a car.
std::size_t surveys_in(const std::vector<std::vector<CarPeriod>>& periods, std::size_t cars) {
    return static_cast<std::size_t>(std::count_if(
        periods.begin() + static_cast<std::ptrdiff_t>(cars), periods.end(), [](const auto& survey) {
            return survey.front().shared > 0;
        }));
}

CalibratedCar calibrated_car(const Car& car, const std::vector<CarPeriod>& periods) {
    CalibratedCar calibrated{car.row, car.pseudonym, car.trips, 0, {}};
    for (const auto& period : periods) {
        calibrated.shared += period.shared;
        if (period.calibration) {
            calibrated.calibration = period.calibration;
        }
    }
    const auto& last = calibrated.calibration;
    if (last && (periods.size() > 1 || last->scatter > 1)) {
        calibrated.periods = periods;
    }
    return calibrated;
}

void write_rules(Database& database, const CalibrationReport& calibration) {
    CarRecords records;
    for (const auto& car : calibration.cars) {
        if (car.calibration) {
            records[car.row] = {*car.calibration,
                                static_cast<std::int64_t>(car.trips),
                                static_cast<std::int64_t>(car.shared),
                                car.periods};
        }
    }
    write_calibrations(database, records);
    write_fusion_config(database, calibration.components);
}

} // namespace

CalibrationReport find_calibration(Database& database,
                                   std::int64_t segments_per_chunk,
                                   CalibrationBasis basis,
                                   const Progress& progress) {
    const auto fleet = fleet_of(database, basis);
    auto readings = readings_of(database, segments_per_chunk, fleet, basis, progress);
    const auto [found, periods, left_out] = calibrate_changing_fleet(
        std::move(readings.all), fleet.origins, fleet.known, {}, readings.stated_sd());
    const auto count = static_cast<double>(std::max<std::size_t>(1, readings.of_cars));

    CalibrationReport report{.generation = read_generation(database),
                             .cars = {},
                             .components = {},
                             .car_relative_sd = found.car_sd,
                             .readings = readings.of_cars,
                             .surveys = surveys_in(periods, fleet.cars.size()),
                             .places = found.places,
                             .left_out_readings = left_out.count,
                             .left_out_held = left_out.held};
    bool any = false;
    for (std::size_t i = 0; i < fleet.cars.size(); ++i) {
        report.cars.push_back(calibrated_car(fleet.cars[i], periods[i]));
        any = any || report.cars.back().calibration;
    }
    const auto places = places_of_cars(read_cars(database));
    std::ranges::sort(report.cars, {}, [&](const auto& car) { return places.at(car.vehicle); });
    if (any) {
        report.components = components_of(found, readings.stated_square / count);
    }
    return report;
}

void build_shadow_calibration(Database& database, const CalibrationReport& calibration) {
    database.run("CREATE TEMP TABLE calibration AS SELECT * FROM main.calibration WHERE 0;"
                 "CREATE TEMP TABLE calibration_period AS SELECT * FROM main.calibration_period"
                 " WHERE 0;"
                 "CREATE TEMP TABLE fusion_setting (key TEXT PRIMARY KEY NOT NULL, value INTEGER);"
                 "INSERT INTO temp.fusion_setting SELECT key, value FROM main.fusion_setting");
    write_rules(database, calibration);
}

void take_calibration(Database& database, const CalibrationReport& calibration) {
    begin_generation(database);
    write_rules(database, calibration);
}

} // namespace macadam
