#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

namespace macadam {

/// Progress callback and stop token of a long operation. `report(done, whole)` is called from time
/// to time on the working thread; whole = 0 means that the total is not known.
struct Progress {
    std::function<void(std::size_t done, std::size_t whole)> report;
    std::stop_token stop;

    void operator()(std::size_t done, std::size_t whole) const {
        if (report) {
            report(done, whole);
        }
    }
};

} // namespace macadam
