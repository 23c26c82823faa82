#pragma once

#include "storage/trips/trip_search.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

namespace macadam {

/// Finds the trips of a folder that are complete, each once. A plain macadam-trip log is complete
/// if it has its end row and was closed or moved here, or did not change for ten seconds; without
/// an end row, after five minutes. Other trips are complete if they did not change for ten seconds,
/// or for a minute once they were seen to grow (some loggers close their file after each row), and
/// no program of this machine has them open for writing, as far as the kernel tells. A
/// link whose target does not appear within that time counts as well, so that it is reported. A
/// file that changes later counts as new.
class SettledTrips {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::chrono::seconds settling{10};
    static constexpr std::chrono::minutes settling_after_change{1};
    static constexpr std::chrono::minutes end_row_wait{5};

    SettledTrips(std::filesystem::path folder, TripWalkConfig config);

    /// Returns the complete trips that were not returned before.
    ///
    /// \param closed  files that were closed or moved here since the last call
    /// \throws InputError  if the folder cannot be read.
    std::vector<std::filesystem::path> take(const std::set<std::filesystem::path>& closed,
                                            Clock::time_point now = Clock::now());

    /// Tests whether trips are there that were not complete at the last call.
    bool has_incomplete() const { return has_incomplete_; }

private:
    /// Size and time of change of a file, or of all files of an export.
    struct Version {
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type changed = std::filesystem::file_time_type::min();
        friend bool operator==(const Version&, const Version&) = default;
    };
    struct Candidate {
        Version version;
        Clock::time_point since; ///< when this version was first seen
        bool is_closed = false;
        bool has_changed = false; ///< while it was watched
        bool is_taken = false;
    };

    static Version version_of(const std::filesystem::path& trip);
    bool is_complete(const std::filesystem::path& trip,
                     const Candidate& candidate,
                     Clock::time_point now) const;

    std::filesystem::path folder_;
    TripWalkConfig config_;
    std::map<std::filesystem::path, Candidate> candidates_;
    bool has_incomplete_ = false;
    bool is_first_look_ = true;
};

} // namespace macadam
