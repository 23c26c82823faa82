#include "estimator/smoother/filter/counter_rng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace macadam::testing {

TEST(NormalDraw, IsStandardNormalAndItsNeighboursAreStrangers) {
    constexpr int count = 40000;
    double mean = 0;
    double square = 0;
    double fourth = 0;
    std::array<double, 3> beside{};
    for (std::uint64_t where = 0; where < count; ++where) {
        const double z = counter_normal(1, 2, where, 0);
        mean += z;
        square += z * z;
        fourth += z * z * z * z;
        beside[0] += z * counter_normal(1, 2, where + 1, 0);
        beside[1] += z * counter_normal(1, 2, where, 1);
        beside[2] += z * counter_normal(2, 2, where, 0);
    }
    const double sd = 1 / std::sqrt(count);
    EXPECT_NEAR(mean / count, 0, 4 * sd);
    EXPECT_NEAR(square / count, 1, 4 * std::sqrt(2) * sd);
    EXPECT_NEAR(fourth / count, 3, 4 * std::sqrt(96) * sd);
    for (const double product : beside) {
        EXPECT_NEAR(product / count, 0, 4 * sd);
    }
}

} // namespace macadam::testing
