#include "estimator/smoother/filter/counter_rng.hpp"

#include "estimator/common/splitmix.hpp"

#include <cmath>
#include <numbers>

namespace macadam {
namespace {

std::uint64_t mixed(std::uint64_t x) {
    return splitmix_mixed(x + splitmix_gamma);
}

double unit(std::uint64_t bits) { // in (0, 1]
    return (static_cast<double>(bits >> 11U) + 1) * 0x1p-53;
}

} // namespace

double
counter_normal(std::uint64_t seed, std::uint64_t what, std::uint64_t where, std::uint64_t which) {
    const std::uint64_t key = mixed(mixed(mixed(seed ^ (what << 48U)) ^ where) ^ which);
    const double radius = std::sqrt(-2 * std::log(unit(key)));
    return radius * std::cos(2 * std::numbers::pi * unit(mixed(key)));
}

} // namespace macadam
