#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "storage/trips/trip_search.hpp"

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// For the tables of the commands that read many trips.
inline constexpr Option max_members_option{
    "--max-members", "N", "Maximum number of files in an archive.", "1000"};

/// \throws UsageError  for what is no such number.
std::size_t max_members_of(const Arguments& arguments);

/// The trips of several paths, one after the other, in the order of the paths, for whoever asks:
/// several threads may.
class AskedTrips {
public:
    /// Says of folders what is not read there; of archives that is known at the end (tell_rest).
    AskedTrips(const std::vector<std::filesystem::path>& paths,
               const TripWalkConfig& config,
               const Console& console);

    /// Takes the next trip; std::nullopt at the end. A path that does not exist is given as a trip,
    /// and reading it says so.
    std::optional<TripSource> next();

    /// Number of trips; std::nullopt while an archive may hold more.
    std::optional<std::size_t> count() const;

    std::size_t at_least() const; ///< so many there are

    /// Reports files in archives that were not read, once all trips were taken.
    void tell_rest(const Console& console) const;

private:
    struct Path {
        std::filesystem::path path;
        std::optional<TripWalk> walk; ///< nothing: `refusal` says why
        std::string refusal;
        bool told = false;
    };

    static void tell(const Path& path, const Console& console);

    mutable std::mutex asking_;
    std::vector<Path> paths_;
    std::size_t at_ = 0;
};

} // namespace macadam
