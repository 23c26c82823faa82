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

/// The trips of one archive in one pass: a log where it stands, a trip of several files when all of
/// them came. Each comes with its contents. What cannot be had is a source whose reading says why.
class ArchivedTrips {
public:
    /// Which trips are sought.
    struct Sought {
        bool (*is_log)(std::string_view name); ///< null: no logs, but exports of phones alone
        std::shared_ptr<const TripMapping> mapping{}; ///< if given, its trips and no others
        std::size_t max_files = max_archive_files;
    };

    ArchivedTrips(std::filesystem::path archive, Sought sought);
    ArchivedTrips(const ArchivedTrips&) = delete;
    ArchivedTrips& operator=(const ArchivedTrips&) = delete;
    ~ArchivedTrips();

    /// Nothing at the end.
    std::optional<TripSource> next();

    std::size_t other_files() const { return other_files_; } ///< passed over so far
    const std::string& first_other_file() const { return first_other_file_; } ///< "" = none

private:
    struct Shelf;

    void take(const std::string& name);
    void take_log(const std::string& name);
    void take_for_export(const std::string& name);
    void take_for_mapping(const std::string& name);
    void hand_out_export(const std::string& folder);
    void hand_out_mapped(const std::string& first, bool even_if_incomplete);
    void refuse(const std::string& member, const std::string& words);
    void pass_over(const std::string& name);
    void end();

    std::filesystem::path archive_;
    Sought sought_;
    std::unique_ptr<ArchiveFiles> files_;
    std::unique_ptr<Shelf> shelf_;
    std::deque<TripSource> ready_;
    std::size_t other_files_ = 0;
    std::string first_other_file_;
    bool begun_ = false;
    bool ended_ = false;
};

} // namespace macadam
