#include "estimator/simulation/portable_math.hpp"

#include <cmath>
#include <limits>

namespace macadam::exact {

namespace {

// pi/2 and ln 2 in parts of 33 bits, so that small whole multiples of the first two are exact
// (W. J. Cody, W. Waite, "Software Manual for the Elementary Functions", 1980).
constexpr double half_pi_1 = 0x1.921fb544p+0;
constexpr double half_pi_2 = 0x1.0b4611a6p-34;
constexpr double half_pi_3 = 0x1.3198a2e037073p-69;
constexpr double ln2_1 = 0x1.62e42fefp-1;
constexpr double ln2_2 = 0x1.473de6afp-34;
constexpr double ln2_3 = 0x1.3c7673007e5edp-69;
constexpr double pi = 0x1.921fb54442d18p+1;

/// x| <= pi/4: the first omitted term is below 1e-19 of the result.
double sin_series(double x) {
    const double x2 = x * x;
    double sum = 0;
    for (const double k : {16 * 17.0, 14 * 15.0, 12 * 13.0, 10 * 11.0, 8 * 9.0, 6 * 7.0, 4 * 5.0}) {
        sum = -x2 / k * (1 + sum);
    }
    return x + x * (-x2 / 6 * (1 + sum));
}

double cos_series(double x) {
    const double x2 = x * x;
    double sum = 0;
    for (const double k : {15 * 16.0, 13 * 14.0, 11 * 12.0, 9 * 10.0, 7 * 8.0, 5 * 6.0, 3 * 4.0}) {
        sum = -x2 / k * (1 + sum);
    }
    return 1 - x2 / 2 * (1 + sum);
}

/// Returns the sine of radians + quarters * pi/2.
double sine(double radians, int quarters) {
    const double turns = std::floor(radians / half_pi_1 + 0.5);
    const double x = ((radians - turns * half_pi_1) - turns * half_pi_2) - turns * half_pi_3;
    const int quarter = (static_cast<int>(turns) + quarters) & 3;
    const double value = quarter % 2 == 0 ? sin_series(x) : cos_series(x);
    return quarter < 2 ? value : -value;
}

/// |t| <= 1/8
double atan_series(double t) {
    const double t2 = t * t;
    double sum = 0;
    for (const double k : {17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0}) {
        sum = t2 * (1 / k - sum);
    }
    return t - t * sum;
}

/// 0 <= t <= 1, from the nearest quarter.
double atan_of_fraction(double t) {
    constexpr double atan_of_quarters[] = {
        0, 0.24497866312686414, 0.4636476090008061, 0.6435011087932844, 0.7853981633974483};
    const int nearest = static_cast<int>(std::floor(4 * t + 0.5));
    const double c = nearest / 4.0;
    return atan_of_quarters[nearest] + atan_series((t - c) / (1 + t * c));
}

} // namespace

double sin(double radians) {
    return sine(radians, 0);
}

double cos(double radians) {
    return sine(radians, 1);
}

double exp(double x) {
    if (x < -708) {
        return 0;
    }
    if (x > 709) {
        return std::numeric_limits<double>::infinity();
    }
    const double twos = std::floor(x / ln2_1 + 0.5);
    const double rest = ((x - twos * ln2_1) - twos * ln2_2) - twos * ln2_3;
    double sum = 1;
    for (int k = 14; k >= 1; --k) {
        sum = 1 + rest / k * sum;
    }
    return std::ldexp(sum, static_cast<int>(twos));
}

double log(double x) {
    int twos = 0;
    double m = std::frexp(x, &twos);
    if (m < 0.70710678118654752) {
        m *= 2;
        --twos;
    }
    const double s = (m - 1) / (m + 1); // log m = 2 atanh s, |s| < 0.172
    const double s2 = s * s;
    double sum = 0;
    for (int k = 21; k >= 3; k -= 2) {
        sum = s2 * (1.0 / k + sum);
    }
    return twos * ln2_1 + (2 * s + (2 * s * sum + twos * ln2_2));
}

double pow(double x, double y) {
    return exp(y * log(x));
}

double atan2(double y, double x) {
    const double along = std::abs(x);
    const double up = std::abs(y);
    if (up == 0 && along == 0) {
        return 0;
    }
    double angle = up <= along ? atan_of_fraction(up / along)
                               : (half_pi_1 - atan_of_fraction(along / up)) + half_pi_2;
    if (x < 0) {
        angle = pi - angle;
    }
    return y < 0 ? -angle : angle;
}

} // namespace macadam::exact
