// The elementary functions that the program links (estimator/elementary_functions).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace macadam {
namespace {

/// A function in double, which is musl's here, and in long double, which is glibc's and has 11 bits
/// more.
struct Function {
    const char* name;
    double (*of)(double);
    long double (*exact)(long double);
    double from, to;
    double most_ulp = 1;
};

constexpr Function functions[] = {
    {"exp", std::exp, std::exp, -700, 700},       {"exp2", std::exp2, std::exp2, -1000, 1000},
    {"expm1", std::expm1, std::expm1, -30, 30},   {"log", std::log, std::log, 1e-3, 1e3},
    {"log2", std::log2, std::log2, 1e-3, 1e3},    {"log10", std::log10, std::log10, 1e-3, 1e3},
    {"log1p", std::log1p, std::log1p, -0.99, 10}, {"cbrt", std::cbrt, std::cbrt, -1e3, 1e3},
    {"sin", std::sin, std::sin, -1e4, 1e4},       {"cos", std::cos, std::cos, -1e4, 1e4},
    {"tan", std::tan, std::tan, -1e4, 1e4},       {"asin", std::asin, std::asin, -1, 1},
    {"acos", std::acos, std::acos, -1, 1},        {"atan", std::atan, std::atan, -50, 50},
    {"sinh", std::sinh, std::sinh, -20, 20, 3},   {"cosh", std::cosh, std::cosh, -20, 20},
    {"tanh", std::tanh, std::tanh, -5, 5, 3},     {"asinh", std::asinh, std::asinh, -100, 100, 3},
    {"erf", std::erf, std::erf, -3, 3},           {"erfc", std::erfc, std::erfc, -3, 5, 3},
};

double ulp(long double of) {
    const double near = std::abs(static_cast<double>(of));
    return std::nextafter(near, std::numeric_limits<double>::infinity()) - near;
}

// 3 where musl subtracts what is nearly equal.
TEST(ElementaryFunctions, ErrByLessThanOneUnitInTheLastPlace) {
    constexpr int steps = 100'000;
    for (const auto& [name, of, exact, from, to, most_ulp] : functions) {
        double worst = 0;
        for (int i = 0; i <= steps; ++i) {
            const double x = from + (to - from) * i / steps;
            const auto expected = exact(x);
            worst =
                std::max(worst, static_cast<double>(std::abs(of(x) - expected)) / ulp(expected));
        }
        EXPECT_LT(worst, most_ulp) << name;
    }
}

TEST(ElementaryFunctions, OfTwoNumbersErrByLessThanTwoUnits) {
    for (double x = -9.7; x < 10; x += 0.0371) {
        for (double y = -9.3; y < 10; y += 0.0413) {
            const long double xl = x, yl = y;
            ASSERT_LT(std::abs(std::atan2(x, y) - std::atan2(xl, yl)), 2 * ulp(std::atan2(xl, yl)));
            ASSERT_LT(std::abs(std::hypot(x, y) - std::hypot(xl, yl)), 2 * ulp(std::hypot(xl, yl)));
            const auto power = std::pow(std::abs(xl), yl);
            ASSERT_LT(std::abs(std::pow(std::abs(x), y) - power), ulp(power));
        }
    }
}

TEST(ElementaryFunctions, KnowTheEndsOfTheNumberLine) {
    const double infinity = std::numeric_limits<double>::infinity();
    volatile double zero = 0; // not computed by the compiler
    EXPECT_EQ(std::exp(zero), 1);
    EXPECT_EQ(std::exp(zero - 800), 0);
    EXPECT_EQ(std::exp(zero + 800), infinity);
    EXPECT_EQ(std::log(zero), -infinity);
    EXPECT_TRUE(std::isnan(std::log(zero - 1)));
    EXPECT_TRUE(std::isnan(std::sin(zero + infinity)));
    EXPECT_EQ(std::pow(zero, zero), 1);
    EXPECT_EQ(std::atan2(zero, -1 - zero), std::atan2(0.0, -1.0));
    EXPECT_EQ(std::hypot(infinity, zero - NAN), infinity);
    EXPECT_NEAR(std::lgamma(zero + 10), std::log(362880.0), 1e-14);
    EXPECT_LT(std::abs(std::exp(std::complex{zero + 1, zero + 2}) - std::polar(std::exp(1.0), 2.0)),
              1e-15);
}

} // namespace
} // namespace macadam
