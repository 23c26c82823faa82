#include "estimator/common/error.hpp"
#include "estimator/iri/iri.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

namespace macadam {
namespace {

using Complex = std::complex<double>;

// Sign changes of the stroke closer together than this remain undetected: a twentieth of the
// shortest wavelength that passes the golden car.
constexpr double look_every_m = 0.02;

// Allows for one missing station of an even profile at the coarsest step.
constexpr double longest_step_m = 2 * coarsest_step_m;

void check_step(double station_m, double step_m) {
    if (!(step_m > 0 && step_m <= longest_step_m)) {
        throw InputError{fmt::format("profile step at station {} m is {:.6g} m, expected 0 to {}",
                                     station_m,
                                     step_m,
                                     longest_step_m)};
    }
}

void check_within(std::span<const double> edges_m, double first_m, double last_m) {
    if (edges_m.front() < first_m || edges_m.back() > last_m) {
        throw InputError{fmt::format(
            "segment borders must increase, from {} m to at most {} m", first_m, last_m)};
    }
}

/// Piecewise linear function, extrapolated linearly beyond both ends.
class PiecewiseLine {
public:
    PiecewiseLine(std::span<const double> station_m, std::span<const double> elevation_m)
        : station_m_{station_m}, elevation_m_{elevation_m} {}

    /// Positions must be passed in increasing order.
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

/// Natural modes of the golden car, over distance: two conjugate pairs, stored by one member each.
/// Every pole has a negative real part, so all modes decay.
struct Modes {
    std::array<Complex, 2> pole_per_m;
    std::array<Complex, 2> input;  ///< from slope to mode
    std::array<Complex, 2> output; ///< from mode to stroke, doubled for its conjugate
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

/// Stroke over one interval with linear slope: two decaying waves on a straight line.
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

/// Drives the car's modes interval by interval.
class GoldenDrive {
public:
    explicit GoldenDrive(double start_slope) : modes_{modes_of_golden_car()} {
        const Eigen::Vector4cd state{start_slope, 0, start_slope, 0};
        for (std::size_t i = 0; i < state_.size(); ++i) {
            state_[i] = (modes_.project[i] * state).value();
        }
    }

    /// Advances by `length_m` while the slope changes from `from` to `to`, and returns the stroke
    /// there.
    Piece drive(double from, double to, double length_m) {
        const double bend_per_m = (to - from) / length_m;
        Piece piece{{}, modes_.pole_per_m, 0, 0};
        for (std::size_t i = 0; i < state_.size(); ++i) {
            // q' = pole q + input (from + bend x): the particular solution is linear, the
            // homogeneous one decays.
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
    // The error after 40 halvings of 20 mm is below the square of the profile's last printed digit.
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

/// Returns the positions where the input slope changes its derivative (with the box) or jumps
/// (without), after `after_m` and up to `until_m`, and the edges there.
std::vector<double> breaks_between(std::span<const double> station_m,
                                   std::span<const double> edges_m,
                                   double half_box_m,
                                   double after_m,
                                   double until_m) {
    std::vector<double> breaks_m;
    const auto add = [&](double at_m) {
        if (at_m > after_m && at_m <= until_m) {
            breaks_m.push_back(at_m);
        }
    };
    for (const double at_m : station_m) {
        add(at_m - half_box_m);
        add(at_m + half_box_m);
    }
    for (auto edge = std::ranges::upper_bound(edges_m, after_m);
         edge != edges_m.end() && *edge <= until_m;
         ++edge) {
        breaks_m.push_back(*edge);
    }
    std::ranges::sort(breaks_m);
    breaks_m.erase(std::unique(breaks_m.begin(), breaks_m.end()), breaks_m.end());
    return breaks_m;
}

} // namespace

/// Drives in batches, each as far as the box lies within the available points.
class ExactIri::Drive {
public:
    Drive(std::vector<double> edges_m, bool envelope, StrokeValue value)
        : edges_m_{std::move(edges_m)},
          half_box_m_{envelope ? contact_patch_m / 2 : 0}, value_{value} {}

    void push(double station_m, double elevation_m) {
        if (!std::isfinite(station_m) || !std::isfinite(elevation_m)) {
            throw InputError{fmt::format("profile point {} is '{} {}', expected finite numbers",
                                         pushed_,
                                         station_m,
                                         elevation_m)};
        }
        if (pushed_ == 0) {
            first_station_m_ = station_m;
            at_m_ = station_m;
        } else {
            check_step(station_m, station_m - station_m_.back());
        }
        ++pushed_;
        station_m_.push_back(station_m);
        elevation_m_.push_back(elevation_m);
        constexpr std::size_t batch = 512;
        if (pushed_ % batch == 0 && station_m - first_station_m_ > start_up_m + contact_patch_m) {
            drive_to(station_m - half_box_m_);
        }
    }

    void finish() {
        if (pushed_ < 2) {
            throw InputError{fmt::format("profile has {} points, expected at least 2", pushed_)};
        }
        const double mean_step_m =
            (station_m_.back() - first_station_m_) / static_cast<double>(pushed_ - 1);
        // Printed stations have few decimals, so differences are compared with a tolerance.
        if (mean_step_m > coarsest_step_m * (1 + 1e-9)) {
            throw InputError{fmt::format("profile step is {:.6g} m in the mean, expected 0 to {}",
                                         mean_step_m,
                                         coarsest_step_m)};
        }
        check_within(edges_m_, first_station_m_, station_m_.back());
        drive_to(edges_m_.back());
    }

    std::optional<double> next() {
        if (next_ == means_.size()) {
            return {};
        }
        return means_[next_++];
    }

private:
    void start() {
        const double base_m = std::min(start_up_m, station_m_.back() - first_station_m_);
        PiecewiseLine profile{station_m_, elevation_m_};
        const double rise_m = profile(first_station_m_ + base_m) - elevation_m_.front();
        car_.emplace(rise_m / base_m);
    }

    void drive_to(double until_m) {
        if (!car_) {
            start();
        }
        PiecewiseLine front{station_m_, elevation_m_};
        PiecewiseLine rear{station_m_, elevation_m_};
        const auto boxed_slope = [&](double at_m) {
            return (front(at_m + half_box_m_) - rear(at_m - half_box_m_)) / contact_patch_m;
        };
        const bool boxed = half_box_m_ > 0;
        double slope = boxed ? boxed_slope(at_m_) : 0;
        for (const double next_m : breaks_between(
                 station_m_, edges_m_, half_box_m_, at_m_, std::min(until_m, edges_m_.back()))) {
            const double length_m = next_m - at_m_;
            const double from = boxed ? slope : (front(next_m) - rear(at_m_)) / length_m;
            slope = boxed ? boxed_slope(next_m) : from;
            add(car_->drive(from, slope, length_m), next_m);
        }
        forget();
    }

    /// Adds the stroke between at_m_ and `next_m` to its segment.
    void add(const Piece& piece, double next_m) {
        const double length_m = next_m - at_m_;
        if (at_m_ >= edges_m_.front()) {
            sum_ += 1000 * (value_ == StrokeValue::integral ? rectified_integral(piece, length_m)
                                                            : std::abs(piece(length_m)) * length_m);
            const double from_m = edges_m_[means_.size()];
            if (const double to_m = edges_m_[means_.size() + 1]; next_m >= to_m) {
                means_.push_back(std::exchange(sum_, 0) / (to_m - from_m));
            }
        }
        at_m_ = next_m;
    }

    /// Drops the points that the box no longer reaches.
    void forget() {
        const auto needed = std::ranges::upper_bound(station_m_, at_m_ - half_box_m_);
        const auto passed = std::max<std::ptrdiff_t>(0, needed - station_m_.begin() - 1);
        station_m_.erase(station_m_.begin(), station_m_.begin() + passed);
        elevation_m_.erase(elevation_m_.begin(), elevation_m_.begin() + passed);
    }

    std::vector<double> edges_m_;
    double half_box_m_;
    StrokeValue value_;
    std::vector<double> station_m_; ///< of the points still needed
    std::vector<double> elevation_m_;
    std::size_t pushed_ = 0;
    double first_station_m_ = 0;
    double at_m_ = 0; ///< position of the car
    std::optional<GoldenDrive> car_;
    double sum_ = 0;
    std::vector<double> means_;
    std::size_t next_ = 0;
};

ExactIri::ExactIri(std::vector<double> edges_m, bool envelope, StrokeValue value)
    : drive_{std::make_unique<Drive>(std::move(edges_m), envelope, value)} {}

ExactIri::ExactIri(ExactIri&&) noexcept = default;
ExactIri& ExactIri::operator=(ExactIri&&) noexcept = default;
ExactIri::~ExactIri() = default;

void ExactIri::push(double station_m, double elevation_m) {
    drive_->push(station_m, elevation_m);
}

void ExactIri::finish() {
    drive_->finish();
}

std::optional<double> ExactIri::next() {
    return drive_->next();
}

std::vector<double> exact_iri_mm_per_m(std::span<const double> station_m,
                                       std::span<const double> elevation_m,
                                       std::span<const double> edges_m,
                                       bool envelope,
                                       StrokeValue value) {
    if (station_m.size() < 2 || station_m.size() != elevation_m.size()) {
        throw InputError{
            fmt::format("profile has {} stations and {} elevations, expected as many, at least 2",
                        station_m.size(),
                        elevation_m.size())};
    }
    ExactIri iri{{edges_m.begin(), edges_m.end()}, envelope, value};
    check_within(edges_m, station_m.front(), station_m.back());
    for (std::size_t i = 0; i < station_m.size(); ++i) {
        iri.push(station_m[i], elevation_m[i]);
    }
    iri.finish();
    std::vector<double> means;
    while (const auto mean = iri.next()) {
        means.push_back(*mean);
    }
    return means;
}

} // namespace macadam
