#include "likelihood_runs.hpp"

#include "estimator/identification/likelihood/likelihood_fit.hpp"
#include "estimator/identification/profile_registration.hpp"
#include "estimator/identification/spectrum_fit.hpp"
#include "estimator/simulation/random.hpp"
#include "estimator/smoother/driven_road.hpp"
#include "estimator/smoother/worlds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace macadam::testing {
namespace {

constexpr double profile_step_m = 0.1;
constexpr double profiler_noise_m = 1e-4;

/// The file of every car: what its owner knows, and how well.
Vehicle file_of(const World& world) {
    auto file = two_axle_car(world.axles, world.imu_ahead_m);
    file.axles->dynamic_index = 1;
    file.half_car.antiroll_n_per_m = 6000;
    file.uncertainty = {{"ms_kg", 0.10},
                        {"mu_kg", 0.15},
                        {"ks_n_per_m", 0.2},
                        {"cs_ns_per_m", 0.25},
                        {"kt_n_per_m", 0.15},
                        {"is_kgm2", 0.2},
                        {"antiroll_n_per_m", 0.3},
                        {"dynamic_index", 0.08},
                        {"rear_ratio", 0.1},
                        {"gain", 0.05}};
    return file;
}

/// A number that changes over a length along the road, about 0.
std::vector<double>
wandering(std::size_t count, double step_m, double sd, double length_m, Random& random) {
    std::vector<double> values;
    const double keep = std::exp(-step_m / length_m);
    double rough = sd * random.normal();
    double smooth = rough;
    for (std::size_t i = 0; i < count; ++i) {
        rough = keep * rough + sd * std::sqrt(1 - keep * keep) * random.normal();
        smooth = keep * smooth + (1 - keep) * rough;
        values.push_back(smooth);
    }
    return values;
}

/// The tracks of a car that keeps its lane as drivers do, a decimetre beside the profiler.
RoadUnderWheels driven_tracks(const RoadSurface& surface, double half_width_m, Random& random) {
    RoadUnderWheels road{.step_m = surface.step_m, .left_m = {}, .right_m = {}};
    const auto count = surface.elevation_m[0].size();
    const auto beside_m = wandering(count, surface.step_m, 0.1, 60, random);
    for (std::size_t i = 0; i < count; ++i) {
        const double station_m = surface.step_m * static_cast<double>(i);
        const auto height = [&](double lateral_m) {
            return static_cast<float>(elevation_m(surface, station_m, lateral_m + beside_m[i]));
        };
        road.left_m.push_back(height(half_width_m));
        road.right_m.push_back(height(-half_width_m));
    }
    return road;
}

RoadProfile surveyed(const RoadSurface& surface, Random& random) {
    RoadProfile profile;
    for (double at_m = 0; at_m < surface.length_m(); at_m += profile_step_m) {
        profile.station_m.push_back(at_m);
        profile.left_m.push_back(elevation_m(surface, at_m, wheel_path_m) +
                                 profiler_noise_m * random.normal());
        profile.right_m.push_back(elevation_m(surface, at_m, -wheel_path_m) +
                                  profiler_noise_m * random.normal());
    }
    return profile;
}

/// Readings of another gain, at travels of an odometer that is 0.3 % and some decimetres off.
Stretch as_recorded(Stretch stretch, double gain, Random& random) {
    const double scale = 1 + 0.003 * random.normal();
    const double begin_m = random.uniform(-1, 1);
    const auto off_m = wandering(stretch.travel_m.size(), 0.4, 0.3, 100, random);
    for (std::size_t k = 0; k < stretch.travel_m.size(); ++k) {
        stretch.vertical_mps2[k] *= static_cast<float>(gain);
        stretch.lateral_mps2[k] *= static_cast<float>(gain);
        stretch.travel_m[k] = scale * stretch.travel_m[k] + begin_m + off_m[k];
    }
    return stretch;
}

Vehicle drawn(Vehicle vehicle, Random& random) {
    auto car = expected_car(vehicle);
    for (const auto& parameter : parameters_of(vehicle, true)) {
        if (vehicle.uncertainty.contains(std::string{parameter.name})) {
            parameter.in(car) *= std::exp(parameter.prior_sd * random.normal());
        }
    }
    return car.vehicle;
}

struct Run {
    Vehicle file, truth;
    DriveRecipe recipe;
    Stretch stretch;
    RoadProfile profile;
};

Run run_of(std::size_t number) {
    const auto& world = worlds()[number % worlds().size()];
    Random random{1000 + number};
    Run run{.file = file_of(world), .truth = {}, .recipe = {}, .stretch = {}, .profile = {}};
    run.truth = drawn(run.file, random);
    run.truth.uncertainty.clear();
    run.recipe.road = world.road;
    run.recipe.car.vehicle = run.truth;
    run.recipe.car.antiroll_n_per_m = run.truth.half_car.antiroll_n_per_m;
    run.recipe.length_m = 1200;
    run.recipe.speed_kmh = random.uniform(50, 80);
    run.recipe.imu_seed = number;
    auto& car = run.recipe.car;
    car.friction_n = random.uniform(15, 60) * run.truth.half_car.ms_kg / 1400;
    car.rebound_ratio = random.uniform(1, 1.6);
    car.tyre_contact_m = random.uniform(0.08, 0.15);
    car.cg_above_roll_axis_m = random.uniform(0.35, 0.55);
    car.pitch_arm_m = random.uniform(0.2, 0.5);
    const auto surface = make_surface(world.road, run.recipe.length_m, number);
    run.profile = surveyed(surface, random);
    run.stretch = as_recorded(
        stretch_over(driven_tracks(surface, run.truth.half_car.l_m, random), run.recipe),
        run.truth.gain,
        random);
    return run;
}

/// Scales with the mass, so that only its ratio to the mass can be known.
bool is_of_mass(const std::string& name) {
    return name != "gain" && name != "dynamic_index" && name != "rear_ratio";
}

void count_inside(const LikelihoodFit& fit, const Run& run, RunsReport& report) {
    constexpr double z_of_95_percent = 1.96;
    auto truth = expected_car(run.truth);
    truth.vehicle.half_car.friction_n = run.recipe.car.friction_n;
    const auto parameters = parameters_of(run.file, true);
    const double mass_error = std::log(fit.vehicle.half_car.ms_kg / truth.vehicle.half_car.ms_kg);
    for (const auto& fitted : fit.parameters) {
        const auto& parameter = *std::ranges::find(parameters, fitted.name, &CarParameter::name);
        const double error = std::log(fitted.found / parameter.in(truth));
        auto& count = report.parameters[fitted.name];
        count.sd_sum += fitted.sd;
        count.inside += std::abs(error) <= z_of_95_percent * fitted.sd ? 1U : 0U;
        if (fitted.name != "ms_kg") {
            const double ratio_error = error - (is_of_mass(fitted.name) ? mass_error : 0);
            count.sd_given_mass_sum += fitted.sd_given_mass;
            count.inside_given_mass +=
                std::abs(ratio_error) <= z_of_95_percent * fitted.sd_given_mass ? 1U : 0U;
        }
    }
}

/// Another road under the same car, read by the smoother: relative errors of its mean HRI.
class OtherRoad {
public:
    OtherRoad(const Run& run, std::size_t number) {
        auto recipe = run.recipe;
        recipe.road = worlds()[(number + 3) % worlds().size()].road;
        recipe.imu_seed += 1000;
        const auto surface = make_surface(recipe.road, recipe.length_m, 500 + number);
        Random random{77 + number};
        stretch_ = stretch_over(driven_tracks(surface, run.truth.half_car.l_m, random), recipe);
        for (float& reading : stretch_.vertical_mps2) {
            reading *= static_cast<float>(run.truth.gain);
        }
        truth_ = true_stroke(wheel_paths(surface));
    }

    double error_of(const Vehicle& vehicle) const {
        const auto run = smoothed(stretch_, vehicle, vertical_and_pitch);
        return errors_of(held_beside(run, truth_, Index::hri, 40, vehicle)).bias;
    }

private:
    Stretch stretch_;
    TrueStroke truth_;
};

} // namespace

double IriErrors::rms() const {
    double sum = 0;
    for (const double error : each) {
        sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(each.size()));
}

std::size_t IriErrors::within(double limit) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(each, [=](double error) { return std::abs(error) <= limit; }));
}

RunsReport report_of_runs(std::size_t count) {
    RunsReport report{};
    report.runs = count;
    for (std::size_t number = 0; number < count; ++number) {
        const auto run = run_of(number);
        const auto place = find_place(std::vector{run.stretch}, run.profile, run.file);
        const auto drive = drive_on_profile(run.stretch, run.profile, run.file, place->at_m);
        const auto fit = fit_likelihood(*drive, run.file, {});
        count_inside(fit, run, report);
        const auto ride = simulate_response(run.stretch, run.profile, place->at_m);
        const auto by_spectrum = identified(
            run.file,
            fit_spectra(*ride, run.file.half_car, run.file.imu.height_above_roll_axis_m, {}));
        const OtherRoad other{run, number};
        auto truth = run.truth;
        truth.half_car.friction_n = run.recipe.car.friction_n;
        report.found.each.push_back(other.error_of(fit.vehicle));
        report.truth.each.push_back(other.error_of(truth));
        report.found_to_truth.each.push_back(report.found.each.back() - report.truth.each.back());
        report.spectrum.each.push_back(other.error_of(by_spectrum));
        report.file.each.push_back(other.error_of(run.file));
    }
    return report;
}

void print(const RunsReport& report) {
    const auto runs = static_cast<double>(report.runs);
    for (const auto& [name, count] : report.parameters) {
        std::printf("%-18s inside its 95 %% interval in %zu of %zu, mean sd %.1f %%; given the "
                    "mass in %zu, %.1f %%\n",
                    name.c_str(),
                    count.inside,
                    report.runs,
                    100 * count.sd_sum / runs,
                    count.inside_given_mass,
                    100 * count.sd_given_mass_sum / runs);
    }
    const auto line = [&](const char* what, const IriErrors& errors) {
        std::printf("HRI of another road by %s: error %.1f %% rms, within 3 %% in %zu of %zu\n",
                    what,
                    100 * errors.rms(),
                    errors.within(0.03),
                    report.runs);
    };
    line("the identified car", report.found);
    line("--method spectrum", report.spectrum);
    line("the file's car", report.file);
    line("the true car", report.truth);
    line("the identified car, relative to the true one", report.found_to_truth);
}

} // namespace macadam::testing
