#pragma once

#include "mapping/fusion/car_period.hpp"
#include "mapping/fusion/fusion.hpp"
#include "mapping/network/segment.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

// Requests and results of maintenance operations, see StoreMaintenance.

/// Trips that a database is to forget.
struct ForgetRequest {
    std::vector<std::string> trips; ///< each a trip_id, a file name or the SHA-256 of the content
    /// Each a vehicle_id, if the key is available, or a pseudonym.
    std::vector<std::string> vehicles;
};

struct Forgotten {
    std::size_t trips = 0;
    std::size_t passes = 0;
    std::size_t segments = 0;  ///< with these passes
    bool calibrated = false;   ///< cars were recalibrated without these trips
    bool log_is_clean = false; ///< the WAL beside the database holds no data of them
};

/// Trips of a new generation.
struct Reprocessed {
    int generation;
    std::size_t trips = 0;  ///< reprocessed
    std::size_t others = 0; ///< not reprocessed
    bool calibrated = false;
};

/// Operation on a database.
struct AuditEntry {
    std::int64_t id;
    std::string at; ///< by the clock of the machine, UTC
    int generation;
    std::string what; ///< "import", "forget", "valid-from", "calibrate", ...
    std::string detail;
    std::optional<std::size_t>
        segments; ///< whose value it changed; `std::nullopt`: no longer known
};

/// Change of a segment's value.
struct NumberChange {
    AuditEntry cause;
    std::optional<IriUm> iri_um; ///< value after the change; `std::nullopt`: no pass is left
    std::optional<IriUm> sd_um;
    std::int64_t passes;
};

/// Calibration of a car of the database.
struct CalibratedCar {
    std::int64_t row;    ///< in table vehicle
    std::string vehicle; ///< pseudonym
    std::size_t trips;
    std::size_t shared; ///< passes over places that other cars passed within a year
    /// `std::nullopt`: too few places shared with others.
    std::optional<CarCalibration> calibration;

    /// If the car changed or its passes scatter: its periods, oldest first, of which `calibration`
    /// is that of the last calibrated one. Else empty.
    std::vector<CarPeriod> periods{};
};

/// Calibration of the cars of a database, with the components of their errors
/// (mapping/fusion/fleet/fleet_calibration.hpp).
struct CalibrationReport {
    int generation;
    std::vector<CalibratedCar> cars; ///< in the order of StoreUsage::cars, without the unknown car
    FusionConfig components;         ///< the default ones if no car could be calibrated
    double car_relative_sd;          ///< spread between cars
    std::size_t readings;            ///< passes of cars that were used
    std::size_t surveys; ///< reference surveys that set the level; 0: the mean of the cars does
    std::size_t places;  ///< with passes of two or more cars
    std::size_t left_out_readings; ///< predicted from other cars (left_out_cars.hpp)
    std::size_t left_out_held;     ///< of these, inside their 90 % prediction interval
};

/// Segment whose passes count only from a certain day on.
struct ValidSince {
    SegmentKey segment;
    std::int64_t from_ms; ///< since 1970 UTC
};

} // namespace macadam
