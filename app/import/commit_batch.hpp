#pragma once

#include "app/import/import_trips.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {

/// Trip on its way into the database.
struct ProcessedTrip {
    TripReport report;
    TripRecord record; ///< valid, as are passes and traces, if the report says so
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
    std::optional<std::vector<PassEvent>> events;
};

/// Trips that are committed together and then reported, in their order. A commit takes the same
/// disk time for one trip as for many. Uncommitted trips must be processed again after a kill.
class CommitBatch {
public:
    using Clock = std::chrono::steady_clock;

    void add(ProcessedTrip trip) {
        if (trips_.empty()) {
            due_ = Clock::now() + max_age;
        }
        passes_ += trip.passes.size();
        trips_.push_back(std::move(trip));
    }

    /// Time of the next commit; `std::nullopt` if no trip waits.
    std::optional<Clock::time_point> due() const {
        return trips_.empty() ? std::nullopt : std::optional{due_};
    }

    bool is_full() const {
        return trips_.size() >= max_trips || passes_ >= max_passes ||
               (!trips_.empty() && Clock::now() >= due_);
    }

    std::vector<ProcessedTrip> empty() {
        passes_ = 0;
        return std::exchange(trips_, {});
    }

private:
    static constexpr std::size_t max_trips = 100;
    static constexpr std::size_t max_passes = 50'000;
    static constexpr std::chrono::seconds max_age{1};

    std::vector<ProcessedTrip> trips_;
    std::size_t passes_ = 0;
    Clock::time_point due_;
};

} // namespace macadam
