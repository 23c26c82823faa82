#include "estimator/common/error.hpp"
#include "estimator/iri.hpp"
#include "estimator/quarter_car.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace macadam {
namespace {

using Complex = std::complex<double>;

// Sign changes of the stroke closer together than this would be seen as none: a twentieth of the
// shortest wavelength that gets through the golden car.
constexpr double look_every_m = 0.02;

// One station lost of an even profile at the coarsest step.
constexpr double longest_step_m = 2 * coarsest_step_m;

void check(std::span<const double> station_m,
           std::span<const double> elevation_m,
           std::span<const double> edges_m) {
    if (station_m.size() < 2 || station_m.size() != elevation_m.size()) {
        throw InputError{
            fmt::format("profile has {} stations and {} elevations, expected as many, at least 2",
                        station_m.size(),
                        elevation_m.size())};
    }
    for (std::size_t i = 0; i < station_m.size(); ++i) {
        if (!std::isfinite(station_m[i]) || !std::isfinite(elevation_m[i])) {
            throw InputError{fmt::format("profile point {} is '{} {}', expected finite numbers",
                                         i,
                                         station_m[i],
                                         elevation_m[i])};
        }
        const double step_m = i == 0 ? coarsest_step_m : station_m[i] - station_m[i - 1];
        if (!(step_m > 0 && step_m <= longest_step_m)) {
            throw InputError{
                fmt::format("profile step at station {} m is {:.6g} m, expected 0 to {}",
                            station_m[i],
                            step_m,
                            longest_step_m)};
        }
    }
    const double mean_step_m =
        (station_m.back() - station_m.front()) / static_cast<double>(station_m.size() - 1);
    // Stations are printed with a few decimals: their differences are not held to the last bit.
    if (mean_step_m > coarsest_step_m * (1 + 1e-9)) {
        throw InputError{fmt::format("profile step is {:.6g} m in the mean, expected 0 to {}",
                                     mean_step_m,
                                     coarsest_step_m)};
    }
    if (edges_m.size() < 2 || !std::ranges::is_sorted(edges_m, std::less_equal{}) ||
        edges_m.front() < station_m.front() || edges_m.back() > station_m.back()) {
        throw InputError{fmt::format("segment borders must rise from {} m to {} m at most",
                                     station_m.front(),
                                     station_m.back())};
    }
}

/// Straight lines between stations, and straight on beyond both ends.
class PiecewiseLine {
public:
    PiecewiseLine(std::span<const double> station_m, std::span<const double> elevation_m)
        : station_m_{station_m}, elevation_m_{elevation_m} {}

    /// Asked for rising places only.
    double operator()(double at_m) {
        while (piece_ + 2 < station_m_.size() && station_m_[piece_ + 1] <= at_m) {
            ++piece_;
        }
        const double rise_m = elevation_m_[piece_ + 1] - elevation_m_[piece_];
        const double run_m = station_m_[piece_ + 1] - station_m_[piece_];
        return elevation_m_[piece_] + rise_m / run_m * (at_m - station_m_[piece_]);
    }

private:
    std::span<const double> station_m_;
    std::span<const double> elevation_m_;
    std::size_t piece_ = 0;
};

/// Where the slope that the car is given bends (with the box) or jumps (without), and the edges.
std::vector<double>
breaks_of(std::span<const double> station_m, std::span<const double> edges_m, double half_box_m) {
    std::vector<double> breaks_m{station_m.front()};
    for (const double at_m : station_m) {
        for (const double break_m : {at_m - half_box_m, at_m + half_box_m}) {
            if (break_m > station_m.front() && break_m < edges_m.back()) {
                breaks_m.push_back(break_m);
            }
        }
    }
    breaks_m.insert(breaks_m.end(), edges_m.begin(), edges_m.end());
    std::ranges::sort(breaks_m);
    const auto repeated = std::ranges::unique(breaks_m);
    breaks_m.erase(repeated.begin(), repeated.end());
    return breaks_m;
}

/// The golden car in its natural modes, over distance: two conjugate pairs, of which one each is
/// kept. Every pole lies left of zero, so nothing ever grows.
struct Modes {
    std::array<Complex, 2> pole_per_m;
    std::array<Complex, 2> input;  ///< of the slope into the mode
    std::array<Complex, 2> output; ///< of the mode into the stroke, doubled for its conjugate
    std::array<Eigen::RowVector4cd, 2> project;
};

Modes modes_of_golden_car() {
    const auto car = golden_car();
    const Eigen::EigenSolver<Eigen::Matrix4d> solver{car.a / golden_speed_mps};
    const Eigen::Matrix4cd shapes = solver.eigenvectors();
    const Eigen::Matrix4cd project = shapes.inverse();
    Modes modes{};
    std::size_t pair = 0;
    for (int i = 0; i < 4; ++i) {
        if (solver.eigenvalues()[i].imag() > 0) {
            modes.pole_per_m[pair] = solver.eigenvalues()[i];
            modes.input[pair] =
                (project.row(i) * (car.b / golden_speed_mps).cast<Complex>()).value();
            modes.output[pair] = 2.0 * (car.c.cast<Complex>() * shapes.col(i)).value();
            modes.project[pair] = project.row(i);
            ++pair;
        }
    }
    return modes;
}

/// The stroke over one piece with linear slope: two decaying waves on a straight line.
struct Piece {
    std::array<Complex, 2> wave;
    std::array<Complex, 2> pole_per_m;
    double level;
    double grade_per_m;

    double operator()(double x_m) const {
        Complex sum = level + grade_per_m * x_m;
        for (std::size_t i = 0; i < wave.size(); ++i) {
            sum += wave[i] * std::exp(pole_per_m[i] * x_m);
        }
        return sum.real();
    }

    double integral(double from_m, double to_m) const {
        const double mean_m = (from_m + to_m) / 2;
        Complex sum = (level + grade_per_m * mean_m) * (to_m - from_m);
        for (std::size_t i = 0; i < wave.size(); ++i) {
            const auto pole = pole_per_m[i];
            sum += wave[i] / pole * (std::exp(pole * to_m) - std::exp(pole * from_m));
        }
        return sum.real();
    }
};

/// The car's modes, driven piece by piece.
class GoldenDrive {
public:
    explicit GoldenDrive(double start_slope) : modes_{modes_of_golden_car()} {
        const Eigen::Vector4cd state{start_slope, 0, start_slope, 0};
        for (std::size_t i = 0; i < state_.size(); ++i) {
            state_[i] = (modes_.project[i] * state).value();
        }
    }

    /// Drives on by `length_m` with the slope going from `from` to `to`, and tells the stroke
    /// there.
    Piece drive(double from, double to, double length_m) {
        const double bend_per_m = (to - from) / length_m;
        Piece piece{{}, modes_.pole_per_m, 0, 0};
        for (std::size_t i = 0; i < state_.size(); ++i) {
            // q' = pole q + input (from + bend x): the particular solution is straight, the rest
            // decays.
            const auto pole = modes_.pole_per_m[i];
            const auto grade = -modes_.input[i] * bend_per_m / pole;
            const auto level = (grade - modes_.input[i] * from) / pole;
            const auto wave = state_[i] - level;
            piece.wave[i] = modes_.output[i] * wave;
            piece.level += (modes_.output[i] * level).real();
            piece.grade_per_m += (modes_.output[i] * grade).real();
            state_[i] = wave * std::exp(pole * length_m) + level + grade * length_m;
        }
        return piece;
    }

private:
    Modes modes_;
    std::array<Complex, 2> state_{};
};

double zero_between(const Piece& piece, double low_m, double high_m) {
    const bool low_negative = piece(low_m) < 0;
    // 40 halvings of 20 mm leave less than the error of the profile's last printed digit squared.
    for (int i = 0; i < 40; ++i) {
        const double middle_m = (low_m + high_m) / 2;
        ((piece(middle_m) < 0) == low_negative ? low_m : high_m) = middle_m;
    }
    return low_m;
}

double rectified_integral(const Piece& piece, double length_m) {
    const auto looks = static_cast<int>(std::ceil(length_m / look_every_m));
    double sum = 0;
    double from_m = 0;
    double last_m = 0;
    for (int i = 1; i <= looks; ++i) {
        const double at_m = length_m * i / looks;
        if ((piece(last_m) < 0) != (piece(at_m) < 0)) {
            const double zero_m = zero_between(piece, last_m, at_m);
            sum += std::abs(piece.integral(from_m, zero_m));
            from_m = zero_m;
        }
        last_m = at_m;
    }
    return sum + std::abs(piece.integral(from_m, length_m));
}

} // namespace

std::vector<double> exact_iri_mm_per_m(std::span<const double> station_m,
                                       std::span<const double> elevation_m,
                                       std::span<const double> edges_m,
                                       bool envelope) {
    check(station_m, elevation_m, edges_m);

    const double half_box_m = envelope ? contact_patch_m / 2 : 0;
    const auto breaks_m = breaks_of(station_m, edges_m, half_box_m);
    const double start_m = station_m.front();
    const double base_m = std::min(start_up_m, station_m.back() - start_m);
    PiecewiseLine profile{station_m, elevation_m};
    GoldenDrive car{(profile(start_m + base_m) - elevation_m.front()) / base_m};

    PiecewiseLine front{station_m, elevation_m};
    PiecewiseLine rear{station_m, elevation_m};
    const auto boxed_slope = [&](double at_m) {
        return (front(at_m + half_box_m) - rear(at_m - half_box_m)) / contact_patch_m;
    };

    std::vector<double> iri(edges_m.size() - 1);
    double slope = envelope ? boxed_slope(start_m) : 0;
    std::size_t segment = 0;
    for (std::size_t i = 0; i + 1 < breaks_m.size(); ++i) {
        const double length_m = breaks_m[i + 1] - breaks_m[i];
        const double from =
            envelope ? slope : (front(breaks_m[i + 1]) - rear(breaks_m[i])) / length_m;
        const double to = envelope ? boxed_slope(breaks_m[i + 1]) : from;
        const auto piece = car.drive(from, to, length_m);
        if (breaks_m[i] >= edges_m.front()) {
            segment += breaks_m[i] >= edges_m[segment + 1] ? 1 : 0;
            iri[segment] += 1000 * rectified_integral(piece, length_m);
        }
        slope = to;
    }
    for (std::size_t i = 0; i < iri.size(); ++i) {
        iri[i] /= edges_m[i + 1] - edges_m[i];
    }
    return iri;
}

} // namespace macadam
