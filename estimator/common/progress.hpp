#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

namespace macadam {

/// How long work tells how far it is, and learns that it is no longer wanted.
/// `report(done, whole)` is called now and then, from the thread that works; whole = 0: not known.
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
