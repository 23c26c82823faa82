#include "app/serve/server_metrics.hpp"

#include <fmt/format.h>

namespace macadam {

void ServerMetrics::add(const HttpRecord& record) {
    constexpr double us_per_s = 1e6;
    const double s = static_cast<double>(record.duration.count()) / us_per_s;
    const std::lock_guard lock{mutex_};
    ++requests_[{std::string{record.route}, record.status}];
    ++durations_[static_cast<std::size_t>(std::ranges::lower_bound(limits_s, s) -
                                          limits_s.begin())];
    duration_s_ += s;
    bytes_ += record.bytes;
}

std::string ServerMetrics::text(std::size_t connections) const {
    const std::lock_guard lock{mutex_};
    std::string text = "# TYPE macadam_http_requests_total counter\n";
    for (const auto& [key, count] : requests_) {
        text += fmt::format("macadam_http_requests_total{{route=\"{}\",code=\"{}\"}} {}\n",
                            key.first,
                            key.second,
                            count);
    }
    text += "# TYPE macadam_http_request_duration_seconds histogram\n";
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < durations_.size(); ++i) {
        total += durations_[i];
        text += fmt::format("macadam_http_request_duration_seconds_bucket{{le=\"{}\"}} {}\n",
                            i < limits_s.size() ? fmt::format("{}", limits_s[i]) : "+Inf",
                            total);
    }
    return text + fmt::format("macadam_http_request_duration_seconds_sum {}\n"
                              "macadam_http_request_duration_seconds_count {}\n"
                              "# TYPE macadam_http_response_bytes_total counter\n"
                              "macadam_http_response_bytes_total {}\n"
                              "# TYPE macadam_http_connections gauge\n"
                              "macadam_http_connections {}\n",
                              duration_s_,
                              total,
                              bytes_,
                              connections);
}

} // namespace macadam
