#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace macadam {

struct TripMapping;  // storage/trips/foreign/column_mapping.hpp
struct TripContents; // storage/trips/source/trip_contents.hpp

/// Which sensors to keep; the rows of the others are counted, not held.
struct TripNeeds {
    bool acc = false;
    bool gyro = false;
    bool speed = false;
    bool fixes = false;

    /// Columns that must be in the header, as groups of which one is enough: {{"t_s"},
    /// {"acc_z_mps2", "acc_y_mps2"}}.
    std::vector<std::vector<std::string>> columns;
};

TripNeeds needs_of_match();
TripNeeds needs_of_match_with_heading(); ///< the rates of turn too, and gravity to level them
TripNeeds needs_of_trace();
TripNeeds needs_of_import();

/// A file that holds a trip, or one inside an archive; or a folder or archive that holds the export
/// of a phone; or a foreign file with its mapping.
struct TripSource {
    std::filesystem::path file;
    std::string member; ///< of the archive; "" for a file of its own; a folder's ends in '/'
    std::vector<std::string> files{}; ///< of a foreign trip, by their names in its folder
    std::shared_ptr<const TripMapping> mapping{}; ///< its tables[i] belongs to files[i]

    /// What an archive held of the trip; null for a trip on disk. A trip that could not be
    /// extracted is a source as well: reading it throws the reason.
    std::shared_ptr<const TripContents> contents{};

    std::string name() const; ///< as messages call it
};

} // namespace macadam
