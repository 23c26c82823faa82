#include "app/parallel/jobs_option.hpp"

#include "app/parallel/free_cores.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace macadam {

std::size_t jobs_of(const Arguments& arguments) {
    constexpr std::int64_t max_jobs = 256;
    const auto jobs = arguments.integer("--jobs");
    if (!jobs) {
        return default_jobs();
    }
    if (*jobs < 1 || *jobs > max_jobs) {
        throw UsageError{fmt::format("--jobs is {}, expected 1 to {}", *jobs, max_jobs)};
    }
    return static_cast<std::size_t>(*jobs);
}

} // namespace macadam
