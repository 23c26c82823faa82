#pragma once

#include "mapping/fusion/fusion.hpp"
#include "mapping/network/segment.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

// What is done to a store beside bringing trips in: values that RoadStore takes and gives.

/// Which trips a store is to forget.
struct ForgetRequest {
    std::vector<std::string> trips;    ///< each a trip_id, a file's name or the hash of its content
    std::vector<std::string> vehicles; ///< each a vehicle_id, for who has the key, or its pseudonym
};

struct Forgotten {
    std::size_t trips = 0;
    std::size_t passes = 0;
    std::size_t segments = 0;  ///< that had these passes
    bool calibrated = false;   ///< cars were calibrated anew without these trips
    bool log_is_clean = false; ///< no byte is left in the log beside the store
};

/// What a new generation was made of.
struct Reprocessed {
    int generation;
    std::size_t trips = 0;  ///< worked out anew
    std::size_t others = 0; ///< of the store, as they were
    bool calibrated = false;
};

/// Something that was done to a store.
struct AuditEntry {
    std::int64_t id;
    std::string at; ///< by the clock of the machine that did it, UTC
    int generation;
    std::string what; ///< "import", "forget", "valid-from", "calibrate", ...
    std::string detail;
    std::size_t segments; ///< whose number changed by it, as far as that is still known
};

/// One change of a segment's number.
struct NumberChange {
    AuditEntry cause;
    std::optional<IriUm> iri_um; ///< from then on; nothing: no pass was left
    std::optional<IriUm> sd_um;
    std::int64_t passes;
};

/// What the passes of a store tell of one of its cars.
struct CalibratedCar {
    std::int64_t row;    ///< of table vehicle
    std::string vehicle; ///< pseudonym
    std::size_t trips;
    std::size_t shared; ///< passes at places where others passed within a year
    std::optional<CarCalibration> calibration; ///< nothing: it shares too little with others
};

/// How the cars of a store read, and of what their errors are made
/// (mapping/fusion/fleet_calibration.hpp).
struct CalibrationReport {
    int generation;
    std::vector<CalibratedCar> cars; ///< as RoadStore::cars(); without trips that name none
    FusionConfig components;         ///< the shipped ones if no car could be calibrated
    double car_relative_sd;          ///< how far cars are off each other
    std::size_t readings;            ///< passes of cars that were looked at
    std::size_t surveys;             ///< that tell what is right; 0: the mean of the cars does
    std::size_t places;              ///< where two or more cars passed
};

/// A segment whose passes count only from a day on.
struct ValidSince {
    SegmentKey segment;
    std::int64_t from_ms; ///< since 1970 UTC
};

} // namespace macadam
