#include "estimator/smoother/filter/vector_kernels.hpp"

#include <gmock/gmock.h>

#include <array>
#include <random>
#include <vector>

namespace macadam::testing {
namespace {

using Vector = std::vector<double>;

Vector numbers(std::size_t count, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    Vector values(count);
    for (double& value : values) {
        value = normal(random);
    }
    return values;
}

/// Whole and broken registers of any width.
constexpr std::array<std::size_t, 8> sizes{1, 2, 3, 4, 7, 16, 33, 70};

} // namespace

TEST(Wide, CopiesTimesANumberToTheBit) {
    for (const auto n : sizes) {
        const auto from = numbers(n, 1);
        Vector expected(n);
        for (std::size_t i = 0; i < n; ++i) {
            expected[i] = 0.7 * from[i];
        }
        Vector to(n);
        wide::copy_times(to.data(), 0.7, from.data(), n);
        EXPECT_EQ(to, expected);
        auto itself = from;
        wide::copy_times(itself.data(), 0.7, itself.data(), n);
        EXPECT_EQ(itself, expected);
    }
}

TEST(Wide, AddsToTheBit) {
    for (const auto n : sizes) {
        const auto from = numbers(n, 1);
        auto to = numbers(n, 2);
        auto expected = to;
        for (std::size_t i = 0; i < n; ++i) {
            const double product = 0.7 * from[i];
            expected[i] = expected[i] + product;
        }
        wide::add(to.data(), 0.7, from.data(), n);
        EXPECT_EQ(to, expected);
    }
}

TEST(Wide, CombinesRowsInTheirOrderToTheBit) {
    constexpr std::size_t terms = 5;
    const auto weights = numbers(terms, 9);
    for (const auto n : sizes) {
        const auto rows = numbers(terms * n, 3);
        std::array<const double*, terms> row{};
        Vector expected(n);
        for (std::size_t k = 0; k < terms; ++k) {
            row[k] = &rows[k * n];
            for (std::size_t i = 0; i < n; ++i) {
                const double product = weights[k] * rows[k * n + i];
                expected[i] = expected[i] + product;
            }
        }
        Vector to = numbers(n, 4); // what was there is lost
        wide::combine(to.data(), row.data(), weights.data(), terms, n);
        EXPECT_EQ(to, expected);
    }
}

TEST(Wide, TakesAProductOffAMatrixToTheBit) {
    for (const auto n : sizes) {
        const auto vector = numbers(n, 1);
        auto matrix = numbers(n * n, 2);
        auto expected = matrix;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                const double product = vector[i] * vector[j];
                expected[i * n + j] = expected[i * n + j] - product;
            }
        }
        wide::downdate(matrix.data(), vector.data(), n);
        EXPECT_EQ(matrix, expected);
    }
}

} // namespace macadam::testing
