#include "mapping/fusion/fleet/anderson_mixing.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam {
namespace {

/// One smoothing round of a chain whose ends are 0 and 1: each value becomes the mean of its
/// neighbours.
Eigen::VectorXd smoothed(const Eigen::VectorXd& chain) {
    const auto last = chain.size() - 1;
    Eigen::VectorXd next = chain;
    for (Eigen::Index i = 0; i <= last; ++i) {
        next[i] = ((i > 0 ? chain[i - 1] : 0) + (i < last ? chain[i + 1] : 1)) / 2;
    }
    return next;
}

double rounds_to_settle(AndersonMixing* mixing) {
    constexpr Eigen::Index links = 40;
    Eigen::VectorXd chain = Eigen::VectorXd::Zero(links);
    for (int round = 0; round < 20'000; ++round) {
        const auto next = smoothed(chain);
        if ((next - chain).cwiseAbs().maxCoeff() < 1e-9) {
            for (Eigen::Index i = 0; i < links; ++i) {
                EXPECT_NEAR(chain[i], double(i + 1) / (links + 1), 1e-5);
            }
            return round;
        }
        chain = mixing != nullptr ? mixing->next(chain, next) : next;
    }
    return INFINITY;
}

TEST(AndersonMixing, SettlesAChainInAFewRoundsForManyOfThePlainIteration) {
    AndersonMixing mixing{8};
    const double plain = rounds_to_settle(nullptr);
    EXPECT_GT(plain, 3000);
    EXPECT_LT(rounds_to_settle(&mixing), plain / 5);
}

TEST(AndersonMixing, SolvesALinearMapInAsManyRoundsAsItHasUnknowns) {
    const Eigen::Vector3d solution{1, -2, 3};
    Eigen::Matrix3d map;
    map << 0.9, 0.1, 0, -0.1, 0.8, 0.1, 0, 0.2, 0.7;
    AndersonMixing mixing{5};
    Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
    for (int round = 0; round < 5; ++round) {
        x = mixing.next(x, solution + map * (x - solution));
    }
    EXPECT_LT((x - solution).norm(), 1e-9);
}

TEST(AndersonMixing, StaysAtAFixedPoint) {
    AndersonMixing mixing{3};
    const Eigen::VectorXd x = Eigen::VectorXd::Ones(4);
    for (int round = 0; round < 4; ++round) {
        EXPECT_EQ(mixing.next(x, x), x);
    }
}

} // namespace
} // namespace macadam
