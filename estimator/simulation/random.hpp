#pragma once

#include <cstdint>
#include <initializer_list>

namespace macadam {

/// Hashes numbers to a seed for the object that they identify, such as the surface of a way in one
/// direction. Different numbers give unrelated seeds.
std::uint64_t seed_of(std::initializer_list<std::uint64_t> numbers);

/// Random numbers that are bit-identical on every machine: only integers and the basic operations
/// of IEEE 754 are used, since the standard's distributions and the mathematics library give no
/// such guarantee.
///
/// Source: D. Blackman, S. Vigna, "Scrambled linear pseudorandom number generators", ACM
/// Transactions on Mathematical Software 47 (2021), no. 36 (xoshiro256++, seeded by splitmix64); G.
/// Marsaglia, T. A. Bray, "A convenient method for generating normal variables", SIAM Review 6
/// (1964), pp. 260-264.
class Random {
public:
    explicit Random(std::uint64_t seed);

    std::uint64_t bits();                     ///< 64 random bits
    double uniform();                         ///< in [0, 1)
    double uniform(double low, double high);  ///< in [low, high)
    std::uint64_t below(std::uint64_t bound); ///< 0 to bound - 1; bound >= 1
    double normal();                          ///< mean 0, standard deviation 1

private:
    std::uint64_t state_[4]{};
    double spare_ = 0;
    bool has_spare_ = false;
};

} // namespace macadam
