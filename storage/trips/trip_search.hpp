#pragma once

#include "estimator/common/progress.hpp"
#include "storage/files/archive.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace macadam {

class ArchivedTrips;

struct TripWalkConfig {
    /// If set, the path is in a foreign format: the file, or every file below the folder that
    /// matches the mapping's first table, is a trip.
    std::shared_ptr<const TripMapping> mapping{};

    /// Every *.gpx and *.nmea [.gz|.zst] is a trip as well, as positions suffice.
    bool tracks = false;

    /// File with the positions of the only trip; empty: those of each log, or of the file beside it
    /// (storage/trips/paired_positions.hpp).
    std::filesystem::path positions{};

    std::size_t max_files = max_archive_files; ///< in an archive

    /// Shows the search for CSV files whose layout is detected, by files; ends it on request.
    Progress search{};
};

/// Iterates over the trips of a path: the file itself, every *.trip.csv[.gz|.zst] below a folder in
/// byte order of the relative paths, or every such file of a .zip, .tar, .tar.gz or .tar.zst
/// archive in its order; and every export of phyphox or Sensor Logger, which is a folder, below a
/// folder, in an archive, or in a .zip below a folder. In a folder or archive without any of these,
/// CSV files whose layout is detected for sure are trips
/// (storage/trips/detection/log_detection.hpp). A recording of positions that belongs to a log is
/// part of its trip.
///
/// An archive is read once, as far as trips are requested; its trips carry their contents.
class TripWalk {
public:
    /// \throws InputError  if there is no such file or folder, or a trip below a folder lacks one
    ///                     of the mapping's files.
    explicit TripWalk(const std::filesystem::path& path, TripWalkConfig config = {});
    TripWalk(TripWalk&&) noexcept;
    ~TripWalk();

    /// Next trip; `std::nullopt` at the end. Reading a trip that could not be extracted throws the
    /// reason.
    std::optional<TripSource> next();

    std::size_t other_files() const { return other_files_; }                  ///< ignored so far
    const std::string& first_other_file() const { return first_other_file_; } ///< "" = none

    /// Number of trips; std::nullopt while an archive may hold more.
    std::optional<std::size_t> count() const;
    std::size_t given() const { return given_; } ///< trips returned so far

    std::vector<std::filesystem::path> files() const; ///< all files that are or will be read

private:
    struct Item {
        TripSource source;
        bool is_archive = false;
        bool is_log = false; ///< the archive may hold logs; otherwise only exports
    };
    using NamedItems = std::vector<std::pair<std::string, Item>>;

    void find_in_folder(const std::filesystem::path& folder);
    void find_mapped(const std::filesystem::path& path);
    void take(NamedItems items);
    void pair(TripSource& source) const;
    void pair_all(const std::filesystem::path& folder,
                  NamedItems& items,
                  std::set<std::string>& others) const;
    TripSource with_positions(TripSource source) const;
    void take_others(std::size_t count, const std::string& first);

    TripWalkConfig config_;
    std::vector<Item> items_;
    std::size_t next_ = 0;
    std::size_t archives_ = 0; ///< remaining archives, including the current one
    std::unique_ptr<ArchivedTrips> archive_;
    std::size_t other_files_ = 0;
    std::string first_other_file_;
    std::size_t given_ = 0;
    std::size_t given_before_archive_ = 0;
};

/// First trip of a path, and the number of trips.
struct FirstTrip {
    std::optional<TripSource> trip;
    std::size_t count = 0;
};
FirstTrip first_trip(const std::filesystem::path& path, const TripWalkConfig& config);

} // namespace macadam
