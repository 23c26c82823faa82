#include "estimator/smoother/filter/counter_rng.hpp"

#include <cmath>
#include <numbers>

namespace macadam {
namespace {

std::uint64_t mixed(std::uint64_t x) { // splitmix64's finalizer
    x += 0x9E3779B97F4A7C15U;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31U);
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
