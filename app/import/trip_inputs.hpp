#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/parallel/jobs_option.hpp"
#include "storage/trips/trip_search.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Option for commands that read many trips.
inline constexpr Option max_members_option =
    rare({"--max-members", "N", "Maximum number of files in an archive.", "1000"});

/// Parses --max-members.
/// \throws UsageError  for an invalid number.
std::size_t max_members_of(const Arguments& arguments);

inline constexpr Option jobs_option =
    preference({"--jobs", "N", "Number of trips processed in parallel.", default_jobs_words});

/// Thread-safe sequence of the trips of several paths, in the order of the paths.
class AskedTrips {
public:
    /// Reports files in folders that are not read; for archives they are known at the end
    /// (tell_rest).
    AskedTrips(const std::vector<std::filesystem::path>& paths,
               const TripWalkConfig& config,
               const Console& console);

    /// Makes a file when its turn comes; it lasts as long as the pointer, which its trips keep.
    using FileMaker = std::function<std::shared_ptr<const std::filesystem::path>()>;

    /// Adds a file that is not there yet, behind all paths.
    /// \param name  for messages, if it cannot be made
    void add(std::filesystem::path name, FileMaker make);

    /// Takes the next trip; `std::nullopt` at the end. A path that does not exist counts as a trip,
    /// and reading it throws.
    std::optional<TripSource> next();

    /// Number of trips; `std::nullopt` while an archive may hold more.
    std::optional<std::size_t> count() const;

    std::size_t at_least() const; ///< lower bound of the count

    /// Reports files in archives that were not read, once all trips were taken.
    void tell_rest(const Console& console) const;

private:
    struct Path {
        std::filesystem::path path;
        std::optional<TripWalk> walk; ///< `std::nullopt`: `refusal` has the reason
        std::string refusal;
        bool is_reported = false;
        FileMaker make{}; ///< of a file that is not there yet
        std::shared_ptr<const std::filesystem::path> held{};
    };

    /// Trips of paths, as far as they are known.
    struct Count {
        std::size_t at_least = 0;
        std::size_t unknown = 0; ///< paths with an archive that may hold more
    };

    static Count count_of(const Path& path);
    void recount(const Count& before, const Count& after);
    static void tell(const Path& path, const Console& console);

    void make_file(Path& path) const;

    TripWalkConfig config_;
    std::mutex asking_; ///< also while a trip is extracted from an archive
    std::vector<Path> paths_;
    std::size_t at_ = 0;
    mutable std::mutex counting_; ///< never held for long
    Count count_;                 ///< of all paths
};

} // namespace macadam
