#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace macadam {

struct TripMapping; // storage/foreign/trip_mapping.hpp

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

    std::string name() const; ///< as messages call it
};

struct TripSearch {
    std::vector<TripSource> trips; ///< in byte order of their relative paths
    std::size_t other_files = 0;   ///< seen and not read
};

/// The trips that a path stands for: itself, every *.trip.csv[.gz|.zst] under a folder, or every
/// such member of a .zip, .tar, .tar.gz or .tar.zst archive; and every export of phyphox or Sensor
/// Logger, which is a folder, under a folder, in an archive, or in a .zip under a folder.
///
/// \param mapping  if given, the path is foreign: itself, or every file under it that fits the
///                 mapping's first table, is a trip.
///
/// \throws InputError  if there is no such file or folder, or a trip lacks one of the mapping's
///                     files.
TripSearch find_trips(const std::filesystem::path& path,
                      const std::shared_ptr<const TripMapping>& mapping = nullptr);

/// The same for what needs positions alone: every *.gpx[.gz|.zst] there is a trip, too.
TripSearch find_tracks(const std::filesystem::path& path,
                       const std::shared_ptr<const TripMapping>& mapping = nullptr);

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
