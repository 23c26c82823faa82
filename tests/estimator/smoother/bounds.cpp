#include "bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace macadam::testing {

void expect_at_most(const char* what, double figure, const Bound& bound) {
    if (figure > bound.wanted) {
        std::printf("NOT REACHED: %s is %.3f, wanted %.3f\n", what, figure, bound.wanted);
    }
    EXPECT_LE(figure, std::max(bound.wanted, bound.reached)) << what;
}

} // namespace macadam::testing
