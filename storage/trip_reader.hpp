#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace macadam {

struct TripMapping;  // storage/foreign/trip_mapping.hpp
struct TripContents; // storage/trip_contents.hpp

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
    std::shared_ptr<const TripMapping> mapping{}; ///< with it files[i] belongs to its tables[i]

    /// What an archive held of it; null for what is read from disk. A trip that could not be had is
    /// a source, too, whose reading says why.
    std::shared_ptr<const TripContents> contents{};

    std::string name() const; ///< as messages call it
};

/// SHA-256 of the decompressed content of a trip, without reading it as one: to know quickly
/// whether it is known.
std::string content_sha256(const TripSource& source);

/// Reads a "macadam-trip 1" log, plain, .gz or .zst, as a stream: its samples, and for every data
/// row what it gave or why it gave nothing. By their names also rawlogs (storage/rawlog_reader.hpp)
/// and GPX tracks (storage/foreign/gpx_reader.hpp).
///
/// \throws InputError  "file:line: ..." if it is not such a log, lacks a needed column, or does
///                     not end with "# end rows: N" and the right N.
TripLog read_trip(const TripSource& source, const TripNeeds& needs, const Progress& progress = {});

} // namespace macadam
