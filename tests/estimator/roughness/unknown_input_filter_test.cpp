#include "estimator/roughness/unknown_input_filter.hpp"

#include "estimator/vehicle/half_car.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>

#include <random>

namespace macadam::testing {
namespace {

const HalfCar car{.ms_kg = 2400,
                  .mu_kg = 90,
                  .ks_n_per_m = 37050,
                  .cs_ns_per_m = 4290,
                  .kt_n_per_m = 370600,
                  .is_kgm2 = 1960,
                  .l_m = 1.0};

/// The paper's equations as they are printed, with the inverse of P.
template <int N, int I, int O>
std::vector<Eigen::Vector<double, I>> literal(const LinearSystem<N, I, O>& system,
                                              double q,
                                              const std::vector<Eigen::Vector<double, O>>& y) {
    using Square = Eigen::Matrix<double, N, N>;
    using Noise = Eigen::Matrix<double, O, O>;
    const auto& [f, g, h] = system;
    Eigen::Vector<double, N> x = Eigen::Vector<double, N>::Zero();
    Square p = 1e4 * Square::Identity();
    std::vector<Eigen::Vector<double, I>> u;
    for (const auto& yk : y) {
        const Eigen::Vector<double, N> xp = f * x;
        const Square pp = f * p * f.transpose() + q * g * g.transpose();
        const Noise s = h * pp * h.transpose() + Noise::Identity();
        const Eigen::Matrix<double, N, O> k = pp * h.transpose() * s.inverse();
        x = xp + k * (yk - h * xp);
        p = (Square::Identity() - k * h) * pp;
        p = (p + p.transpose()).eval() / 2;
        u.push_back(q * g.transpose() * pp.fullPivLu().solve(x - xp));
    }
    return u;
}

template <int O>
std::vector<Eigen::Vector<double, O>> noise(std::size_t count) {
    std::mt19937 random{2};
    std::normal_distribution<double> value{0, 1};
    std::vector<Eigen::Vector<double, O>> y(count);
    for (auto& yk : y) {
        for (int i = 0; i < O; ++i) {
            yk[i] = value(random);
        }
    }
    return y;
}

template <int N, int I, int O>
double worst_difference(const LinearSystem<N, I, O>& system, double q) {
    const auto y = noise<O>(200);
    const auto expected = literal(system, q, y);
    UnknownInputFilter<N, I, O> filter{system, q};
    double worst = 0;
    double size = 0;
    for (std::size_t k = 0; k < y.size(); ++k) {
        worst = std::max(worst, (filter.push(y[k]) - expected[k]).norm());
        size = std::max(size, expected[k].norm());
    }
    return worst / size;
}

/// At a moderate q the printed formula keeps enough digits to be compared with; at 1e9 its inverse
/// of P loses them, which is why it is not used.
TEST(UnknownInputFilter, NeedsNoInverseToBeThePapersFormula) {
    EXPECT_LT(worst_difference(discretise(quarter_car(car), 0.02), 1e3), 1e-6);
    EXPECT_LT(worst_difference(discretise(half_car(car, 0.4), 0.02), 1e3), 1e-6);
    EXPECT_LT(worst_difference(discretise(lateral_half_car(car, 0), 0.02), 1e3), 1e-6);
}

TEST(UnknownInputFilter, FindsTheInputThatWasHeld) {
    const auto system = discretise(quarter_car(car), 0.01);
    std::mt19937 random{5};
    std::normal_distribution<double> road_m{0, 0.01};
    UnknownInputFilter<4, 1, 1> filter{system, 1e9};
    Eigen::Vector4d x = Eigen::Vector4d::Zero();
    double error = 0;
    for (int k = 0; k < 3000; ++k) {
        const double u = road_m(random);
        x = system.a * x + system.b * u;
        const double found = filter.push(system.c * x)[0];
        // Long waves (more than ten seconds) are the filter's to forget; samples differ little by
        // them.
        error = k > 1000 ? std::max(error, std::abs(found - u)) : 0;
    }
    EXPECT_LT(error, 2e-3);
}

TEST(UnknownInputFilter, SettlesAndThenGoesOnAlike) {
    const auto system = discretise(quarter_car(car), 0.02);
    UnknownInputFilter<4, 1, 1> filter{system, 1e9};
    int k = 0;
    for (; k < 30000 && !filter.settled(); ++k) {
        filter.push(Eigen::Vector<double, 1>{std::sin(0.1 * k)});
    }
    EXPECT_TRUE(filter.settled());
    EXPECT_GT(k, 100);
}

} // namespace
} // namespace macadam::testing
