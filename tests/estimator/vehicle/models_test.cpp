#include "estimator/iri/iri.hpp"
#include "estimator/reference_data.hpp"
#include "estimator/vehicle/half_car.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>

#include <complex>
#include <numbers>

namespace macadam::testing {
namespace {

const HalfCar car{.ms_kg = 1600,
                  .mu_kg = 45,
                  .ks_n_per_m = 30000,
                  .cs_ns_per_m = 2500,
                  .kt_n_per_m = 250000,
                  .is_kgm2 = 430,
                  .l_m = 0.78};

TEST(GoldenCar, HasTheTransitionOfTheStandard) {
    const auto table = read_table("iri_reference/golden_car_coefficients.csv", 1);
    ASSERT_FALSE(table.empty());
    for (const auto& row : table) {
        const auto step = discretise(golden_car(), row[0] / golden_speed_mps);
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                const double expected = row[static_cast<std::size_t>(1 + 4 * i + j)];
                EXPECT_NEAR(step.a(i, j), expected, 1e-9 * std::max(1.0, std::abs(expected)));
            }
            const double response = row[static_cast<std::size_t>(17 + i)];
            EXPECT_NEAR(step.b(i, 0), response, 1e-9 * response) << row[0];
        }
    }
}

/// Peaks of the stroke's response and the wavelengths of half of it, as computed from the
/// standard's constants with another program.
TEST(GoldenCar, RespondsMostAtTwoWavelengths) {
    const auto gain = [](double wavelength_m) {
        const auto golden = golden_car();
        const std::complex<double> s{0, 2 * std::numbers::pi * golden_speed_mps / wavelength_m};
        const Eigen::Matrix4cd m =
            s * Eigen::Matrix4cd::Identity() - golden.a.cast<std::complex<double>>();
        const Eigen::Vector4cd x = m.lu().solve(golden.b.cast<std::complex<double>>());
        return std::abs(x[0] - x[2]);
    };
    EXPECT_NEAR(gain(15.77), 1.5376, 1e-4);
    EXPECT_NEAR(gain(2.293), 1.6765, 1e-4);
    EXPECT_NEAR(gain(28.9), 0.5, 1e-3);
    EXPECT_NEAR(gain(1.271), 0.5, 1e-3);
}

TEST(HalfCar, IsAQuarterCarWhereBothTracksAreOne) {
    const auto half = half_car(car, 0);
    const auto quarter = quarter_car(car);
    const std::complex<double> s{0.3, 12};
    const Eigen::Matrix<std::complex<double>, 8, 8> m =
        s * Eigen::Matrix<std::complex<double>, 8, 8>::Identity() -
        half.a.cast<std::complex<double>>();
    const Eigen::Vector<std::complex<double>, 8> x =
        m.lu().solve((half.b.col(0) + half.b.col(1)).cast<std::complex<double>>());
    const Eigen::Matrix4cd n =
        s * Eigen::Matrix4cd::Identity() - quarter.a.cast<std::complex<double>>();
    const Eigen::Vector4cd y = n.lu().solve(quarter.b.cast<std::complex<double>>());
    EXPECT_NEAR(std::abs(x[0] - y[0]), 0, 1e-12);
    EXPECT_NEAR(std::abs(x[2]), 0, 1e-12);
    EXPECT_NEAR(std::abs((half.c.row(0).cast<std::complex<double>>() * x).value() -
                         (quarter.c.cast<std::complex<double>>() * y).value()),
                0,
                1e-9);
}

/// On a road raised on the right by 2 l d in all, the car settles at the angle of the road.
TEST(HalfCar, SettlesAtTheTiltOfTheRoad) {
    const auto half = half_car(car, 0.4);
    const Eigen::Vector<double, 8> at_rest =
        -half.a.lu().solve(half.b * Eigen::Vector2d{-0.01, 0.01});
    EXPECT_NEAR(at_rest[0], 0, 1e-12);
    EXPECT_NEAR(at_rest[2], 0.01 / car.l_m, 1e-12);
    EXPECT_NEAR((half.c * at_rest).norm(), 0, 1e-9);
}

TEST(HalfCar, ABumpOnTheRightThrowsARaisedSensorToTheLeft) {
    const auto half = half_car(car, 0.4);
    const auto step = discretise(half, 0.01);
    const Eigen::Vector<double, 8> after = step.b * Eigen::Vector2d{0, 0.01};
    EXPECT_GT((half.c * after)[1], 0);
    EXPECT_NEAR((half.c * after)[1] * 2.5, (half_car(car, 0).c * after)[1], 1e-12);
}

} // namespace
} // namespace macadam::testing
