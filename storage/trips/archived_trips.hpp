#pragma once

#include "storage/files/archive.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

struct TripContents;

/// Finds the trips of an archive in one pass: single logs immediately, trips of several files when
/// all of them were read. Where logs are sought and there are none, a second pass takes the CSV
/// files whose layout is detected for sure. Each trip carries its contents. Reading a trip that
/// could not be extracted throws the reason.
class ArchivedTrips {
public:
    /// Selection of trips.
    struct Sought {
        bool (*is_log)(std::string_view name);        ///< null: only phone exports, no logs
        std::shared_ptr<const TripMapping> mapping{}; ///< if set, only trips of this mapping
        std::size_t max_files = max_archive_files;
    };

    ArchivedTrips(std::filesystem::path archive, Sought sought);
    ArchivedTrips(const ArchivedTrips&) = delete;
    ArchivedTrips& operator=(const ArchivedTrips&) = delete;
    ~ArchivedTrips();

    /// Next trip; `std::nullopt` at the end.
    std::optional<TripSource> next();

    std::size_t other_files() const { return other_files_; }                  ///< ignored so far
    const std::string& first_other_file() const { return first_other_file_; } ///< "" = none

private:
    struct Shelf;

    void take(const std::string& name);
    void take_log(const std::string& name);
    void take_detected(const std::string& name);
    void take_for_export(const std::string& name);
    void take_for_mapping(const std::string& name);
    void hand_out_export(const std::string& folder);
    void hand_out_mapped(const std::string& first, bool even_if_incomplete);
    void refuse(const std::string& member, const std::string& words);
    void pass_over(const std::string& name);
    void end();
    void search_again();

    std::filesystem::path archive_;
    Sought sought_;
    std::unique_ptr<ArchiveFiles> files_;
    std::unique_ptr<Shelf> shelf_;
    std::deque<TripSource> ready_;
    std::size_t other_files_ = 0;
    std::string first_other_file_;
    bool begun_ = false;
    bool has_trips_ = false;
    bool has_tables_ = false; ///< among the files that were passed over
    bool detects_ = false;    ///< in the second pass
    bool ended_ = false;
};

} // namespace macadam
