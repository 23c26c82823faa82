#pragma once

#include "app/http/http_server.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace macadam {

/// Counts of answered requests for Prometheus, by the pattern of the path and the status.
class ServerMetrics {
public:
    void add(const HttpRecord& record);

    /// Formats the counts (text format 0.0.4 of Prometheus).
    std::string text(std::size_t connections) const;

    /// Upper limits of the histogram of durations, seconds.
    static constexpr std::array limits_s{0.001, 0.005, 0.02, 0.06, 0.25, 1.0, 10.0};

private:
    mutable std::mutex mutex_;
    std::map<std::pair<std::string, int>, std::uint64_t> requests_;
    std::array<std::uint64_t, limits_s.size() + 1> durations_{};
    double duration_s_ = 0;
    std::uint64_t bytes_ = 0;
};

} // namespace macadam
