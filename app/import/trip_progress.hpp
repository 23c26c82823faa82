#pragma once

#include "estimator/common/progress.hpp"

#include <atomic>
#include <cstddef>
#include <stop_token>
#include <utility>

namespace macadam {

/// Progress of one trip of an import, added to a total that all workers share. When the object is
/// destroyed, the trip counts as done.
class TripProgress {
public:
    static constexpr std::size_t whole_trip = 1000; ///< parts in which a trip is counted

    TripProgress(std::atomic<std::size_t>& total, std::stop_token stop)
        : total_{total}, stop_{std::move(stop)} {}
    TripProgress(const TripProgress&) = delete;
    TripProgress& operator=(const TripProgress&) = delete;
    ~TripProgress() { raise_to(whole_trip); }

    /// Returns the progress of a step that takes the trip from `first` to `past` of its parts. The
    /// result must not outlive this object.
    Progress step(std::size_t first, std::size_t past) {
        return {.report =
                    [this, first, past](std::size_t done, std::size_t whole) {
                        if (whole > 0 && done <= whole) {
                            raise_to(first + (past - first) * done / whole);
                        }
                    },
                .stop = stop_};
    }

private:
    void raise_to(std::size_t parts) {
        if (parts > reported_) {
            total_ += parts - reported_;
            reported_ = parts;
        }
    }

    std::atomic<std::size_t>& total_;
    std::stop_token stop_;
    std::size_t reported_ = 0;
};

} // namespace macadam
