#include "estimator/identification/bfgs.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

TEST(Minimum, OfRosenbrocksValleyIsAtItsEnd) {
    const auto found = minimise_bfgs(Eigen::Vector2d{-1.2, 1}, [](const Eigen::VectorXd& x) {
        return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2);
    });
    EXPECT_NEAR(found.at[0], 1, 1e-4); // differences of 1e-5 leave that much at its flat end
    EXPECT_NEAR(found.at[1], 1, 2e-4);
    EXPECT_LT(found.value, 1e-8);
}

TEST(Minimum, OfAnEllipsoidIsTheSolutionOfItsEquations) {
    Eigen::Matrix3d a;
    a << 4, 1, 0, 1, 3, -1, 0, -1, 2;
    const Eigen::Vector3d b{1, 2, 3};
    const auto found = minimise_bfgs(Eigen::Vector3d::Zero(), [&](const Eigen::VectorXd& x) {
        return 0.5 * x.dot(a * x) - b.dot(x);
    });
    EXPECT_LT((found.at - a.inverse() * b).norm(), 1e-5);
}

TEST(Minimum, OfWhatCannotBeLoweredIsItsStart) {
    const auto found =
        minimise_bfgs(Eigen::Vector2d{3, 4}, [](const Eigen::VectorXd&) { return 7.0; });
    EXPECT_EQ(found.at, (Eigen::Vector2d{3, 4}));
    EXPECT_EQ(found.value, 7);
}

} // namespace
} // namespace macadam::testing
