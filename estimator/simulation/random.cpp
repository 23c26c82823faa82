#include "estimator/simulation/random.hpp"

#include "estimator/common/splitmix.hpp"

#include <bit>
#include <cmath>

namespace macadam {

std::uint64_t seed_of(std::initializer_list<std::uint64_t> numbers) {
    std::uint64_t seed = numbers.size();
    for (const std::uint64_t number : numbers) {
        seed = splitmix_mixed(seed + splitmix_gamma + splitmix_mixed(number + splitmix_gamma));
    }
    return seed;
}

Random::Random(std::uint64_t seed) {
    for (auto& word : state_) {
        seed += splitmix_gamma;
        word = splitmix_mixed(seed);
    }
}

std::uint64_t Random::bits() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
}

double Random::uniform() {
    return static_cast<double>(bits() >> 11) * 0x1p-53;
}

double Random::uniform(double low, double high) {
    return low + (high - low) * uniform();
}

std::uint64_t Random::below(std::uint64_t bound) {
    const std::uint64_t uneven = (0 - bound) % bound; // 2^64 mod bound: smaller ones bias it
    std::uint64_t number = bits();
    while (number < uneven) {
        number = bits();
    }
    return number % bound;
}

double Random::normal() {
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    double u = 0;
    double v = 0;
    double square = 0;
    do {
        u = 2 * uniform() - 1;
        v = 2 * uniform() - 1;
        square = u * u + v * v;
    } while (square >= 1 || square == 0);
    const double stretch = std::sqrt(-2 * std::log(square) / square);
    spare_ = v * stretch;
    has_spare_ = true;
    return u * stretch;
}

} // namespace macadam
