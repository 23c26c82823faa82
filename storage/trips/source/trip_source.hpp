#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace macadam {

struct TripMapping;  // storage/trips/mappings/column_mapping.hpp
struct TripContents; // storage/trips/source/trip_contents.hpp

/// Measurement that a command requires.
struct NeededMeasurement {
    std::string name; ///< for people: "position"
    std::string part; ///< "latitude"; "": all of it

    /// Columns of the trip log of which one suffices, the preferred ones first.
    std::vector<std::string> columns;
};

/// Sensors to keep; rows of other sensors are counted but not stored.
struct TripNeeds {
    bool acc = false;
    bool gyro = false;
    bool speed = false;
    bool fixes = false;
    std::vector<NeededMeasurement> required{};
};

TripNeeds needs_of_match();
TripNeeds needs_of_match_with_heading(); ///< including yaw rates, and gravity to level them
TripNeeds needs_of_trace();
TripNeeds needs_of_import();

/// Tests for the columns of the trip log that a recording of a receiver has.
bool is_position_column(const std::string& column);

/// Needs of a log whose positions come from another file, with the sensors by which their clocks
/// can be joined.
TripNeeds needs_beside_positions(const TripNeeds& needs);

/// Tests for a column of the trip log.
using ColumnTest = std::function<bool(const std::string& column)>;

/// Names what a log lacks, for people: "vertical acceleration; position (latitude, longitude)"; ""
/// if it has all.
std::string missing_measurements(const TripNeeds& needs, const ColumnTest& has);

/// Names the columns that a trip log lacks, of alternatives the first two: "lat_deg and lon_deg",
/// "speed_mps or gnss_speed_mps"; "" if it has all.
std::string missing_columns(const TripNeeds& needs, const ColumnTest& has);

/// Origin of a trip: a file, a member of an archive, a folder or archive with the export of a
/// phone, or a foreign file with its mapping.
struct TripSource {
    std::filesystem::path file;
    std::string member; ///< of the archive; "" for a file on its own; a folder's ends in '/'
    std::vector<std::string> files{};             ///< of a foreign trip, relative to its folder
    std::shared_ptr<const TripMapping> mapping{}; ///< its tables[i] applies to files[i]

    /// Contents in memory, as from an archive; null for a trip on disk. A trip that could not be
    /// extracted is a source as well: reading it throws the reason.
    std::shared_ptr<const TripContents> contents{};

    /// File with the positions of a log that has none (storage/trips/positions/joined_trip.hpp);
    /// empty: no such file.
    std::filesystem::path positions{};

    std::shared_ptr<const void> held{}; ///< keeps `file`, if it is there for a while only

    std::string name() const; ///< for messages
};

} // namespace macadam
