#pragma once

#include <cstdint>

namespace macadam {

inline constexpr std::uint64_t splitmix_gamma = 0x9e3779b97f4a7c15U; ///< 2^64 / golden ratio, odd

/// Returns the output function of splitmix64, a bijection in which each bit depends on every other.
///
/// Source: S. Vigna, prng.di.unimi.it, splitmix64.c, 2015.
constexpr std::uint64_t splitmix_mixed(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    return bits ^ (bits >> 31U);
}

} // namespace macadam
