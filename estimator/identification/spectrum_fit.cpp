#include "estimator/identification/spectrum_fit.hpp"

#include "estimator/common/error.hpp"
#include "estimator/identification/bfgs.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace macadam {
namespace {

constexpr double min_duration_s = 10;  // twenty independent values at the smoothing's 0.5 Hz
constexpr double start_is_kgm2 = 3000; // paper table III
constexpr double difference = 1e-4;    // step in the logarithm of a parameter

/// The golden car's springs, damper and tyre under the known masses (paper section VI-A).
HalfCar start_car(const HalfCar& known, double height_m) {
    const auto& golden = built_in_vehicle("golden-car")->half_car;
    HalfCar car = known;
    car.ks_n_per_m = golden.ks_n_per_m;
    car.cs_ns_per_m = golden.cs_ns_per_m;
    car.kt_n_per_m = golden.kt_n_per_m;
    car.is_kgm2 = start_is_kgm2 * (height_m > 0 ? height_m : 1);
    return car;
}

double square_sum(std::span<const double> values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

double square_distance(std::span<const double> a, std::span<const double> b) {
    return std::transform_reduce(
        a.begin(), a.end(), b.begin(), 0.0, std::plus{}, [](double x, double y) {
            return (x - y) * (x - y);
        });
}

/// Measured spectrum of a channel, and the model's as a function of the logarithms of the
/// parameters relative to their initial values.
class Channel {
public:
    using Model = std::function<std::vector<double>(const Eigen::VectorXd&)>;

    Channel(std::span<const double> measured,
            const ProfileResponse& ride,
            const SpectrumFitConfig& config,
            Model felt)
        : step_s_{ride.step_s}, band_{config.band}, skipped_{static_cast<std::size_t>(
                                                        std::ceil(config.run_in_s / ride.step_s))},
          felt_{std::move(felt)}, measured_{spectrum_of(measured)} {}

    std::vector<double> modelled(const Eigen::VectorXd& logs) const {
        return spectrum_of(felt_(logs)).amplitude;
    }

    /// Returns the square of the relative misfit.
    double cost(const Eigen::VectorXd& logs) const {
        return square_distance(measured_.amplitude, modelled(logs)) /
               square_sum(measured_.amplitude);
    }

    ChannelSpectra spectra(const Eigen::VectorXd& found) const {
        const Eigen::VectorXd start = Eigen::VectorXd::Zero(found.size());
        return {.measured = measured_,
                .before = modelled(start),
                .after = modelled(found),
                .misfit_before = std::sqrt(cost(start)),
                .misfit_after = std::sqrt(cost(found))};
    }

    /// Returns the standard deviations of the logarithms, to first order. Amplitudes closer than
    /// the smoothing width count as one observation.
    Eigen::VectorXd sd(const Eigen::VectorXd& found) const {
        const auto count = static_cast<Eigen::Index>(measured_.hz.size());
        Eigen::MatrixXd slopes(count, found.size());
        for (Eigen::Index i = 0; i < found.size(); ++i) {
            const Eigen::VectorXd step = difference * Eigen::VectorXd::Unit(found.size(), i);
            const auto above = modelled(found + step);
            const auto below = modelled(found - step);
            for (Eigen::Index k = 0; k < count; ++k) {
                const auto at = static_cast<std::size_t>(k);
                slopes(k, i) = (above[at] - below[at]) / (2 * difference);
            }
        }
        const double independent = (band_.to_hz - band_.from_hz) / band_.smoothing_hz;
        const double variance = square_distance(measured_.amplitude, modelled(found)) /
                                (independent - static_cast<double>(found.size()));
        const Eigen::MatrixXd inverse =
            (slopes.transpose() * slopes)
                .ldlt()
                .solve(Eigen::MatrixXd::Identity(found.size(), found.size()));
        return (variance * inverse.diagonal()).cwiseSqrt();
    }

private:
    AmplitudeSpectrum spectrum_of(std::span<const double> signal) const {
        return amplitude_spectrum(signal.subspan(skipped_), step_s_, band_);
    }

    double step_s_;
    Band band_;
    std::size_t skipped_;
    Model felt_;
    AmplitudeSpectrum measured_;
};

std::vector<double> times(double gain, std::vector<double> values) {
    std::ranges::for_each(values, [=](double& value) { value *= gain; });
    return values;
}

/// \param logs  logarithms of ks, cs, kt relative to `start`.
HalfCar suspended(HalfCar start, const Eigen::VectorXd& logs) {
    start.ks_n_per_m *= std::exp(logs[0]);
    start.cs_ns_per_m *= std::exp(logs[1]);
    start.kt_n_per_m *= std::exp(logs[2]);
    return start;
}

HalfCar rolling(HalfCar start, const Eigen::VectorXd& logs) {
    start.is_kgm2 *= std::exp(logs[0]);
    return start;
}

Eigen::VectorXd found_in(const Channel& channel, Eigen::Index unknowns) {
    return minimise_bfgs(Eigen::VectorXd::Zero(unknowns),
                         [&](const Eigen::VectorXd& logs) { return channel.cost(logs); })
        .at;
}

bool tracks_differ(const ProfileResponse& ride) {
    return ride.left_m != ride.right_m;
}

void check(const ProfileResponse& ride, const SpectrumFitConfig& config) {
    if (ride.vertical_mps2.empty()) {
        throw InputError{"has no vertical acceleration, which identification needs"};
    }
    const double duration_s = static_cast<double>(ride.vertical_mps2.size() - 1) * ride.step_s;
    if (duration_s < config.run_in_s + min_duration_s) {
        throw InputError{
            fmt::format("drives {:.1f} s continuously on the profile (from {:.0f} to {:.0f} "
                        "m), expected at least {:.0f}",
                        duration_s,
                        ride.from_m,
                        ride.to_m,
                        config.run_in_s + min_duration_s)};
    }
}

} // namespace

SpectrumFit fit_spectra(const ProfileResponse& ride,
                        const HalfCar& known,
                        double height_above_roll_axis_m,
                        const SpectrumFitConfig& config) {
    check(ride, config);
    const auto start = start_car(known, height_above_roll_axis_m);
    const Channel vertical{ride.vertical_mps2, ride, config, [&](const Eigen::VectorXd& logs) {
                               return times(std::exp(logs[3]),
                                            vertical_response(ride, suspended(start, logs)));
                           }};
    const auto found = found_in(vertical, 4);
    const auto sd = vertical.sd(found);
    SpectrumFit fit{
        .start = start,
        .found = suspended(start, found),
        .gain = std::exp(found[3]),
        .vertical = vertical.spectra(found),
        .lateral = {},
        .relative_sd = {
            {"ks_n_per_m", sd[0]}, {"cs_ns_per_m", sd[1]}, {"kt_n_per_m", sd[2]}, {"gain", sd[3]}}};
    if (ride.lateral_mps2.empty() || !tracks_differ(ride)) {
        fit.found.is_kgm2 = known.is_kgm2;
        return fit;
    }
    const auto sprung = fit.found;
    const Channel lateral{
        ride.lateral_mps2, ride, config, [&](const Eigen::VectorXd& logs) {
            return times(fit.gain,
                         lateral_response(ride, rolling(sprung, logs), height_above_roll_axis_m));
        }};
    const auto roll = found_in(lateral, 1);
    fit.found = rolling(sprung, roll);
    fit.lateral = lateral.spectra(roll);
    fit.relative_sd["is_kgm2"] = lateral.sd(roll)[0];
    return fit;
}

Vehicle identified(Vehicle vehicle, const SpectrumFit& fit) {
    vehicle.half_car = fit.found;
    if (vehicle.axles) {
        vehicle.one_axle_gain = fit.gain;
    } else {
        vehicle.gain = fit.gain;
        vehicle.one_axle_gain.reset();
    }
    for (const auto& [name, sd] : fit.relative_sd) {
        vehicle.uncertainty[name] = sd;
    }
    return vehicle;
}

} // namespace macadam
