#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace macadam::testing {

/// Returns a road's roughness at every decimetre of stations [0, length_m), roughly as the golden
/// car smooths it: lognormal with mean 1 and waves from 4 m on. The result depends on the seed
/// alone.
std::vector<double> roughness_pattern(double length_m, std::uint64_t seed);

/// Reading of the roughness by one drive.
struct Reading {
    double from_m = 0; ///< stations of the drive, integers
    double to_m = 0;
    std::function<double(double station_m)> lag_m; ///< the reading at s belongs to s - lag_m(s)
    double gain = 2;
    double noise = 0.3; ///< relative standard deviation per metre
    double place_sd_m = 3;
    std::uint64_t seed = 1;
};

/// Reads the roughness; stations beyond its ends use its end values.
RoughnessTrace read_pattern(const std::vector<double>& pattern, const Reading& reading);

} // namespace macadam::testing
