#include "estimator/identification/likelihood/likelihood_fit.hpp"

#include "estimator/common/error.hpp"
#include "estimator/identification/likelihood/likelihood_problem.hpp"
#include "estimator/identification/likelihood/whitening.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr double min_duration_s = 10; // twenty periods of 0.5 Hz, the whitening's resolution
constexpr double max_step_sd = 1.5;   // of a parameter, in its prior's standard deviations
constexpr double max_shift_step_m = 0.4;
constexpr double block_s = 5; // residuals of two blocks are independent
constexpr std::size_t min_blocks = 10;
constexpr int max_iterations = 16;   // 8 are usual; smooth roads leave the stations open
constexpr double settled_step = 0.1; // last step of the car's parameters, in standard deviations
constexpr double unexcited_above = 2.0 / 3;

// Upper ends of the band in the first iterations: long waves match in spite of stations that are
// half a metre wrong.
constexpr double first_bands_hz[] = {4, 4, 8, 8};

/// Whitened residuals and their derivatives, all channels in one column.
struct Linearised {
    Eigen::MatrixXd residual; ///< not whitened
    Eigen::VectorXd white;
    Eigen::MatrixXd slopes; ///< of the modelled readings, whitened
};

Linearised
linearised(const LikelihoodProblem& problem, const Eigen::VectorXd& by, FrequencyBand band) {
    const auto here = problem.modelled(by);
    Linearised local{.residual = problem.measured() - here, .white = {}, .slopes = {}};
    const Whitening whitening{local.residual, problem.step_s(), band};
    local.white = whitening(local.residual).reshaped();
    local.slopes.resize(local.white.size(), problem.size());
    problem.slopes(by, here, [&](Eigen::Index unknown, const Eigen::MatrixXd& slope) {
        local.slopes.col(unknown) = whitening(slope).reshaped();
    });
    return local;
}

/// Limits a step to some prior standard deviations and some decimetres.
Eigen::VectorXd limited(Eigen::VectorXd step, const LikelihoodProblem& problem) {
    const auto& parameters = problem.parameters();
    double most = 1;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double limit =
            at < parameters.size() ? max_step_sd * parameters[at].prior_sd : max_shift_step_m;
        most = std::max(most, std::abs(step[i]) / limit);
    }
    return step / most;
}

double last_frequency_hz(const LikelihoodProblem& problem, const LikelihoodFitConfig& config) {
    return std::min(config.to_hz, 0.45 / problem.step_s());
}

/// Maximum of the posterior.
struct Peak {
    Eigen::VectorXd by;
    Eigen::MatrixXd covariance;
    Eigen::MatrixXd residual;
    bool settled;
};

/// Returns the sum over blocks of time of the squared gradient of the log-likelihood.
Eigen::MatrixXd score_squares(const LikelihoodProblem& problem, const Linearised& local) {
    const auto rows = problem.window().rows();
    const auto block = static_cast<Eigen::Index>(block_s / problem.step_s());
    Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(problem.size(), problem.size());
    for (Eigen::Index from = 0; from < rows; from += block) {
        const auto count = std::min(block, rows - from);
        Eigen::VectorXd score = Eigen::VectorXd::Zero(problem.size());
        for (Eigen::Index at = from; at < local.white.size(); at += rows) {
            score +=
                local.slopes.middleRows(at, count).transpose() * local.white.segment(at, count);
        }
        squares += score * score.transpose();
    }
    return squares;
}

/// Returns the inverse information, widened to the sandwich's standard deviations and by the model
/// error.
Eigen::MatrixXd covariance_of(const LikelihoodProblem& problem, const Linearised& local) {
    const Eigen::MatrixXd inverse =
        (local.slopes.transpose() * local.slopes + problem.prior()).inverse();
    Eigen::MatrixXd covariance = inverse;
    const auto blocks = static_cast<double>(problem.window().rows()) * problem.step_s() / block_s;
    if (blocks >= static_cast<double>(min_blocks)) {
        const Eigen::MatrixXd sandwich =
            inverse * (score_squares(problem, local) + problem.prior()) * inverse;
        const Eigen::VectorXd wider =
            (sandwich.diagonal().array() / inverse.diagonal().array()).max(1).sqrt();
        covariance = wider.asDiagonal() * inverse * wider.asDiagonal();
    }
    const auto& parameters = problem.parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        covariance(row, row) += std::pow(parameters[i].model_sd, 2);
    }
    return covariance;
}

/// \throws InputError  if a value is not finite.
Eigen::VectorXd newton_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient) {
    if (information.allFinite() && gradient.allFinite()) {
        Eigen::VectorXd step = information.ldlt().solve(gradient);
        if (step.allFinite()) {
            return step;
        }
    }
    throw InputError{"cannot be fitted: the modelled readings are not finite, expected a vehicle "
                     "file and a profile that fit the drive"};
}

/// Tests whether a step moves no parameter of the car by a notable part of its standard deviation.
/// The stations are left aside: smooth roads leave them open, without harm to the car.
bool is_settled(const LikelihoodProblem& problem,
                const Eigen::VectorXd& step,
                const Eigen::MatrixXd& information) {
    const auto cars = static_cast<Eigen::Index>(problem.parameters().size());
    const Eigen::VectorXd sd = information.inverse().diagonal().head(cars).cwiseSqrt();
    return (step.head(cars).cwiseAbs().array() < settled_step * sd.array()).all();
}

Peak peak_of(const LikelihoodProblem& problem, const LikelihoodFitConfig& config) {
    Eigen::VectorXd by = problem.start();
    const double last_hz = last_frequency_hz(problem, config);
    for (int iteration = 0;; ++iteration) {
        const auto stage = static_cast<std::size_t>(iteration);
        const bool is_last_band = stage >= std::size(first_bands_hz);
        const auto local = linearised(
            problem,
            by,
            {config.from_hz, is_last_band ? last_hz : std::min(first_bands_hz[stage], last_hz)});
        const Eigen::MatrixXd information =
            local.slopes.transpose() * local.slopes + problem.prior();
        const Eigen::VectorXd gradient =
            local.slopes.transpose() * local.white - problem.prior() * by;
        const auto step = newton_step(information, gradient);
        const bool has_settled = is_last_band && is_settled(problem, step, information);
        if (has_settled || iteration >= max_iterations) {
            return {by, covariance_of(problem, local), local.residual, has_settled};
        }
        by += limited(step, problem);
    }
}

std::vector<FittedParameter>
parameters_in(const LikelihoodProblem& problem, const Peak& peak, std::vector<Eigen::Index>& rows) {
    auto start = problem.expected();
    auto found = problem.car(peak.by);
    const auto& parameters = problem.parameters();
    std::vector<FittedParameter> out;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const auto& parameter = parameters[i];
        const auto row = static_cast<Eigen::Index>(i);
        const double sd = std::sqrt(peak.covariance(row, row));
        if (parameter.in_file) {
            rows.push_back(row);
            out.push_back(
                {.name = std::string{parameter.name},
                 .start = parameter.in(start),
                 .found = parameter.in(found),
                 .prior_sd = parameter.prior_sd,
                 .sd = sd,
                 .sd_given_mass = sd,
                 .drive_sd = std::sqrt(std::max(0.0, sd * sd - std::pow(parameter.model_sd, 2)))});
        }
    }
    return out;
}

/// Conditions the standard deviations on the mass, which is the first parameter if it is one.
void condition_on_mass(std::vector<FittedParameter>& parameters,
                       const Eigen::MatrixXd& correlation) {
    if (parameters.empty() || parameters.front().name != "ms_kg") {
        return;
    }
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const double with_mass = correlation(0, static_cast<Eigen::Index>(i));
        parameters[i].sd_given_mass *= std::sqrt(std::max(0.0, 1 - with_mass * with_mass));
    }
}

std::vector<double> column_of(const Eigen::MatrixXd& readings, Eigen::Index channel) {
    return {readings.col(channel).begin(), readings.col(channel).end()};
}

double norm_of(const AmplitudeSpectrum& spectrum) {
    return Eigen::Map<const Eigen::VectorXd>{spectrum.amplitude.data(),
                                             static_cast<Eigen::Index>(spectrum.amplitude.size())}
        .norm();
}

std::vector<ChannelFit>
spectra_of(const LikelihoodProblem& problem, const Peak& peak, const LikelihoodFitConfig& config) {
    const Band band{.from_hz = config.from_hz,
                    .to_hz = last_frequency_hz(problem, config),
                    .smoothing_hz = 0.5};
    Eigen::VectorXd file = peak.by; // the corrected stations under the file's car
    file.head(static_cast<Eigen::Index>(problem.parameters().size())).setZero();
    const auto before = problem.modelled(file);
    const Eigen::MatrixXd after = problem.measured() - peak.residual;
    std::vector<ChannelFit> out;
    for (Eigen::Index i = 0; i < after.cols(); ++i) {
        const auto spectrum = [&](const Eigen::MatrixXd& readings) {
            return amplitude_spectrum(column_of(readings, i), problem.step_s(), band);
        };
        const auto measured = spectrum(problem.measured());
        const auto misfit = [&](const Eigen::MatrixXd& model) {
            return norm_of(spectrum(problem.measured() - model)) / norm_of(measured);
        };
        const auto channel = problem.window().channels()[static_cast<std::size_t>(i)];
        out.push_back({.channel = static_cast<Channel>(channel),
                       .spectra = {.measured = measured,
                                   .before = spectrum(before).amplitude,
                                   .after = spectrum(after).amplitude,
                                   .misfit_before = misfit(before),
                                   .misfit_after = misfit(after)}});
    }
    return out;
}

void check(const ProfileDrive& drive, const LikelihoodFitConfig& config) {
    const double duration_s = static_cast<double>(drive.station_m.size()) * drive.step_s;
    if (duration_s < config.run_in_s + min_duration_s) {
        throw InputError{
            fmt::format("has {:.1f} s on the profile, from station {:.1f} to {:.1f} m, expected "
                        "{:.0f} s or more without a stop",
                        duration_s,
                        drive.station_m.front(),
                        drive.station_m.back(),
                        config.run_in_s + min_duration_s)};
    }
}

bool is_unexcited(const FittedParameter& parameter) {
    return parameter.drive_sd > unexcited_above * parameter.prior_sd;
}

/// Sets the uncertainty of a fitted vehicle. Mass and friction are left out: the roughness that a
/// car estimates depends on ratios to the mass alone, and little on friction. A friction that
/// neither the file nor the drive tells is left to be estimated from later drives.
void set_uncertainty(Vehicle& vehicle,
                     const std::vector<FittedParameter>& parameters,
                     bool is_friction_stated) {
    for (const auto& parameter : parameters) {
        vehicle.uncertainty[parameter.name] = parameter.sd_given_mass;
    }
    const auto friction =
        std::ranges::find(parameters, std::string_view{"friction_n"}, &FittedParameter::name);
    if (!is_friction_stated && (friction == parameters.end() || is_unexcited(*friction))) {
        vehicle.half_car.friction_n.reset();
    }
    vehicle.uncertainty.erase("ms_kg");
    vehicle.uncertainty.erase("friction_n");
}

} // namespace

LikelihoodFit fit_likelihood(const ProfileDrive& drive,
                             const Vehicle& vehicle,
                             const LikelihoodFitConfig& config) {
    check(drive, config);
    const LikelihoodProblem problem{drive, vehicle, config};
    const auto peak = peak_of(problem, config);
    std::vector<Eigen::Index> rows;
    auto parameters = parameters_in(problem, peak, rows);
    const Eigen::MatrixXd covariance = peak.covariance(rows, rows);
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
    condition_on_mass(parameters, correlation);
    auto found = problem.car(peak.by).vehicle;
    set_uncertainty(found, parameters, vehicle.half_car.friction_n.has_value());
    const auto [least, most] = std::ranges::minmax(problem.shifts(peak.by));
    return {.vehicle = std::move(found),
            .parameters = std::move(parameters),
            .correlation = correlation,
            .channels = spectra_of(problem, peak, config),
            .from_m = drive.station_m.front(),
            .to_m = drive.station_m.back(),
            .duration_s = static_cast<double>(drive.station_m.size() - 1) * drive.step_s,
            .min_shift_m = least,
            .max_shift_m = most,
            .settled = peak.settled};
}

std::vector<std::string> unexcited_parameters(const LikelihoodFit& fit) {
    std::vector<std::string> names;
    for (const auto& parameter : fit.parameters) {
        if (is_unexcited(parameter)) {
            names.push_back(parameter.name);
        }
    }
    return names;
}

} // namespace macadam
