#include "estimator/smoother/vibration/vibration_fit.hpp"

#include "estimator/smoother/car/linear_car.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr std::size_t min_windows = 3; // at a speed

// Octaves of wavelength, 64 to 0.5 m, and the difference of neighbours (logarithm of the power), as
// in the smoother's road.
constexpr int octaves = 8;
constexpr double longest_m = 64;
constexpr double octave_step = 0.7;

constexpr double model_sd = 0.3; // of the logarithm of a linear car's power in a bin
constexpr double trust = 0.25;   // neighbouring bins err alike
constexpr double looks = 1.4;    // independent Fourier components per window and bin
constexpr double over_noise = 3; // bins with less power are not used

constexpr double contact_m = 0.12; // the tyre averages the road over it

/// Part of the power that is felt whatever the distance of the axles: tracks and suspensions differ
/// and nothing cancels entirely.
constexpr double uncancelled = 0.05;

using std::numbers::pi;
using Complex = std::complex<double>;

double hz_of(std::size_t bin) {
    return VibrationSpectra::first_hz + VibrationSpectra::step_hz * static_cast<double>(bin);
}

double sinc2(double x) {
    const double y = pi * x;
    return y < 1e-6 ? 1 : std::pow(std::sin(y) / y, 2);
}

/// What a channel feels of the road under the front and under the rear axle, per metre of
/// elevation.
struct Ends {
    Complex front, rear;
};

std::array<std::array<Ends, VibrationSpectra::bins>, VibrationSpectra::channels>
ends_of(const LinearCar& car) {
    constexpr int n = LinearCar::heave_states;
    using Square = Eigen::Matrix<Complex, n, n>;
    const auto vertical = car.felt[0].head<n>();
    const auto pitch = car.felt[3].head<n>();
    std::array<std::array<Ends, VibrationSpectra::bins>, VibrationSpectra::channels> ends;
    for (std::size_t bin = 0; bin < VibrationSpectra::bins; ++bin) {
        const Complex s{0, 2 * pi * hz_of(bin)};
        const Square dynamics =
            s * Square::Identity() - car.a.topLeftCorner<n, n>().cast<Complex>();
        const Eigen::Matrix<Complex, n, 2> moved =
            dynamics.partialPivLu().solve(car.b.topLeftCorner<n, 2>().cast<Complex>());
        const Eigen::Matrix<Complex, 1, 2> up = vertical.cast<Complex>() * moved;
        const Eigen::Matrix<Complex, 1, 2> turn = pitch.cast<Complex>() * moved;
        ends[0][bin] = {up[0], up[1]};
        ends[1][bin] = {turn[0], turn[1]};
    }
    return ends;
}

} // namespace

VibrationFit::VibrationFit(const VibrationSpectra& spectra, const ImuMount& imu, bool with_pitch) {
    const double noise_sd[] = {imu.noise_mps2,
                               std::max(imu.noise_radps, spectra.pitch_noise_radps)};
    const std::size_t channels = with_pitch ? 2 : 1;
    std::vector<std::size_t> level; // of each row
    std::size_t levels = 0;
    for (const auto& [_, at] : spectra.speeds) {
        if (at.windows < min_windows) {
            continue;
        }
        const auto windows = static_cast<double>(at.windows);
        const double speed_mps = std::exp(at.log_speed / windows);
        for (std::size_t channel = 0; channel < channels; ++channel) {
            for (std::size_t bin = 0; bin < spectra.used_bins; ++bin) {
                const double power = at.power[channel][bin];
                if (power >
                    over_noise * at.noise[channel] * noise_sd[channel] * noise_sd[channel]) {
                    rows_.push_back({speed_mps,
                                     channel,
                                     bin,
                                     std::log(power),
                                     1 / std::hypot(1 / std::sqrt(looks * windows), model_sd)});
                    level.push_back(levels);
                }
            }
            ++levels;
        }
    }
    // Below the rows: neighbouring octaves are alike, and their mean is that of the levels.
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const auto first = static_cast<Eigen::Index>(levels);
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(rows + octaves, first + octaves);
    for (Eigen::Index row = 0; row < rows; ++row) {
        const Row& r = rows_[static_cast<std::size_t>(row)];
        const double octave =
            std::clamp(std::log2(longest_m * hz_of(r.bin) / r.speed_mps), 0.0, octaves - 1 - 1e-9);
        const auto below = static_cast<Eigen::Index>(octave);
        const double share = octave - static_cast<double>(below);
        design(row, static_cast<Eigen::Index>(level[static_cast<std::size_t>(row)])) =
            r.root_weight;
        design(row, first + below) = r.root_weight * (1 - share);
        design(row, first + below + 1) = r.root_weight * share;
    }
    for (Eigen::Index octave = 0; octave + 1 < octaves; ++octave) {
        design(rows + octave, first + octave) = -1 / octave_step;
        design(rows + octave, first + octave + 1) = 1 / octave_step;
    }
    design.bottomRightCorner(1, octaves).setOnes();
    // A level of which no bin is used has a column of zeros: it stays without effect.
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposed{design};
    const Eigen::MatrixXd all =
        decomposed.householderQ() * Eigen::MatrixXd::Identity(rows + octaves, decomposed.rank());
    fitted_ = all;
}

double VibrationFit::slowest_mps() const {
    return rows_.empty() ? 0 : rows_.front().speed_mps;
}

double VibrationFit::fastest_mps() const {
    return rows_.empty() ? 0 : rows_.back().speed_mps;
}

Eigen::VectorXd VibrationFit::modelled(const Vehicle& car) const {
    const LinearCar linear = linear_car(car);
    const auto ends = ends_of(linear);
    const double apart_m = linear.front_m - linear.rear_m;
    Eigen::VectorXd log_power(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        const Row& r = rows_[row];
        const double hz = hz_of(r.bin);
        const double waves_per_m = hz / r.speed_mps;
        const auto& [front, rear] = ends[r.channel][r.bin];
        const Complex sum = front + rear * std::polar(1.0, -2 * pi * waves_per_m * apart_m);
        const double felt =
            std::norm(sum) + uncancelled * std::pow(std::abs(front) + std::abs(rear), 2);
        const double passed =
            car.imu.lowpass_hz > 0
                ? 1 / (1 + std::pow(hz / car.imu.lowpass_hz, 2 * car.imu.lowpass_order))
                : 1;
        log_power[static_cast<Eigen::Index>(row)] =
            std::log(felt * passed * sinc2(contact_m * waves_per_m) / (waves_per_m * waves_per_m));
    }
    return log_power;
}

double VibrationFit::misfit(const Eigen::VectorXd& modelled,
                            const Resonance& mount,
                            double from_mps,
                            double to_mps) const {
    std::array<double, VibrationSpectra::bins> mounted{};
    for (std::size_t bin = 0; bin < mounted.size() && mount.hz > 0; ++bin) {
        mounted[bin] = std::log(std::norm(response(mount, hz_of(bin))));
    }
    Eigen::VectorXd off = Eigen::VectorXd::Zero(fitted_.rows());
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        const Row& r = rows_[row];
        const auto at = static_cast<Eigen::Index>(row);
        const double shaken = r.channel == 0 ? mounted[r.bin] : 0;
        off[at] = r.root_weight * (r.log_power - modelled[at] - shaken);
    }
    off -= fitted_ * (fitted_.transpose() * off);
    double sum = 0;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        if (rows_[row].speed_mps > from_mps && rows_[row].speed_mps <= to_mps) {
            sum += std::pow(off[static_cast<Eigen::Index>(row)], 2);
        }
    }
    return trust * sum;
}

} // namespace macadam
