#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace macadam::testing {

/// A road's roughness at every decimetre of stations [0, length_m), about as the golden car leaves
/// it: a lognormal of mean 1 with waves from 4 m on. Always the same for a seed.
std::vector<double> texture(double length_m, std::uint64_t seed);

/// How a drive reads it.
struct Reading {
    double from_m = 0; ///< the drive's own stations, whole
    double to_m = 0;
    std::function<double(double station_m)> lag_m; ///< what it reads at s lies at s - lag_m(s)
    double gain = 2;
    double noise = 0.3; ///< relative, standard deviation, of each metre
    double place_sd_m = 3;
    std::uint64_t seed = 1;
};

/// Held at the texture's ends.
RoughnessTrace read_texture(const std::vector<double>& texture, const Reading& reading);

} // namespace macadam::testing
