#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace macadam::bench {

/// Seconds that a clock of the process or of the thread has counted.
inline double cpu_s(clockid_t clock = CLOCK_PROCESS_CPUTIME_ID) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double wall_s() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/// CPU seconds of the process.
template <typename Work>
double cost_s(const Work& work) {
    const double begin_s = cpu_s();
    work();
    return cpu_s() - begin_s;
}

template <typename Work>
double cost_ms(const Work& work) {
    return 1e3 * cost_s(work);
}

/// \param values  at least one. \param percent  0 .. 100, of them that are not above it.
inline double percentile(std::vector<double> values, std::size_t percent) {
    std::ranges::sort(values);
    return values[(values.size() - 1) * percent / 100];
}

inline double median(const std::vector<double>& values) {
    return percentile(values, 50);
}

} // namespace macadam::bench
