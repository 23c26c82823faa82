#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace macadam {

struct TripMapping;  // storage/trips/foreign/column_mapping.hpp
struct TripContents; // storage/trips/source/trip_contents.hpp

/// Sensors to keep; rows of other sensors are counted but not stored.
struct TripNeeds {
    bool acc = false;
    bool gyro = false;
    bool speed = false;
    bool fixes = false;

    /// Required columns, as groups of alternatives of which one suffices: {{"t_s"}, {"acc_z_mps2",
    /// "acc_y_mps2"}}.
    std::vector<std::vector<std::string>> columns;
};

TripNeeds needs_of_match();
TripNeeds needs_of_match_with_heading(); ///< including yaw rates, and gravity to level them
TripNeeds needs_of_trace();
TripNeeds needs_of_import();

/// Names the required columns that a log lacks, as in "t_s and acc_z_mps2 or acc_y_mps2"; "" if it
/// has all.
std::string missing_columns(const TripNeeds& needs,
                            const std::function<bool(const std::string& column)>& has);

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

    std::string name() const; ///< for messages
};

} // namespace macadam
