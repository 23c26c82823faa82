#include "estimator/smoother/vibration/car_from_vibration.hpp"

#include "estimator/smoother/vibration/sensor_noise.hpp"
#include "estimator/smoother/vibration/vibration_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace macadam {
namespace {

constexpr double everywhere = std::numeric_limits<double>::infinity();

/// Unknowns of the search, 0 where the vehicle is as stated.
struct Guess {
    double wheelbase_m = 0; ///< 0: as stated
    double ahead = 0;       ///< of the sensor, over the wheelbase
    double hop = 0;         ///< logarithm of tyre stiffness over unsprung mass, ...
    double damping = 0;     ///< ... and of the suspension's damping, friction included
};

struct Expected {
    double mean, sd;
};

/// Wheelbases follow the size of the car: 2.3 m for 1,000 kg, 2.65 m for 1,500 kg, 3.05 m for 2,300
/// kg of sprung mass.
Expected wheelbase_m(const Vehicle& car) {
    return {2.65 * std::cbrt(car.half_car.ms_kg / 1500), 0.25};
}

// Between the middle of the car and a holder at the windscreen.
constexpr Expected usual_ahead{0.10, 0.15};
constexpr double usual_hop_sd = 0.25;
constexpr double known_hop_sd = 0.05;
constexpr double damping_sd = 0.4;

// In 14 simulated trips of exact cars the logarithm of the damping that fits best was within this
// of the true one. The fit's own sd, tempered for cars that are not linear, counts by this part.
constexpr double damping_error_sd = 0.06;
constexpr double damping_fit_error = 0.3;
constexpr double least_shown = 0.25; // over the prior's information

/// In simulated cars the hop that fits best is this far from the true one.
constexpr double hop_error_sd = 0.25;

// Relative standard deviations of a car of a class whose axles were found. The wheelbase, which the
// gain of one axle replaces, is known; damping is 0.2 to 0.4 of critical (vehicle_prior.cpp).
constexpr double holder_gain_sd = 0.06;
constexpr double usual_damping_sd = 0.2;

/// Error of what is left of a resonance, in the unit of Vehicle::uncertainty: 5 % of the IRI.
constexpr double mount_sd = 0.08;

double uncertainty_of(const Vehicle& car, const char* name) {
    const auto found = car.uncertainty.find(name);
    return found == car.uncertainty.end() ? 0 : found->second;
}

bool is_class_of_cars(const Vehicle& car) {
    const Vehicle* built_in = built_in_vehicle(car.name);
    return built_in != nullptr && !car.axles && car.gain == built_in->gain &&
           uncertainty_of(car, "ms_kg") > 0;
}

class Search {
public:
    Search(const VibrationFit& fit, const Vehicle& vehicle) : fit_{fit}, vehicle_{vehicle} {
        const double stated =
            std::hypot(uncertainty_of(vehicle, "kt_n_per_m"), uncertainty_of(vehicle, "mu_kg"));
        hop_sd_ = std::clamp(stated, known_hop_sd, usual_hop_sd);
    }

    Vehicle car(const Guess& guess) const {
        Vehicle car = vehicle_;
        if (guess.wheelbase_m > 0) {
            car.axles =
                Axles{.wheelbase_m = guess.wheelbase_m, .cg_to_front_m = guess.wheelbase_m / 2};
            car.imu.x_m = guess.ahead * guess.wheelbase_m;
        }
        car.half_car.kt_n_per_m *= std::exp(guess.hop);
        car.half_car.cs_ns_per_m *= std::exp(guess.damping);
        return car;
    }

    double unlikely(const Guess& guess) const {
        double sum = std::pow(guess.hop / hop_sd_, 2) + std::pow(guess.damping / damping_sd, 2);
        if (guess.wheelbase_m > 0) {
            const auto usual = wheelbase_m(vehicle_);
            sum += std::pow((guess.wheelbase_m - usual.mean) / usual.sd, 2) +
                   std::pow((guess.ahead - usual_ahead.mean) / usual_ahead.sd, 2);
        }
        return sum;
    }

    double misfit(const Guess& guess, const Resonance& mount = {}) const {
        return fit_.misfit(fit_.modelled(car(guess)), mount) + unlikely(guess);
    }

    /// Descends along one unknown after the other, in steps that are halved.
    Guess refined(Guess guess, Resonance& mount) const {
        double* const unknowns[] = {&guess.hop,
                                    &guess.damping,
                                    &guess.wheelbase_m,
                                    &guess.ahead,
                                    &mount.hz,
                                    &mount.damping};
        double steps[] = {0.2, 0.2, 0.1, 0.1, 0.5, 0.03};
        double best = misfit(guess, mount);
        for (int halvings = 0; halvings < 4; ++halvings) {
            for (std::size_t i = 0; i < std::size(unknowns); ++i) {
                const bool used = i < 2 || (i < 4 ? guess.wheelbase_m > 0 : mount.hz > 0);
                for (const double sign : {1.0, -1.0}) {
                    for (int n = 0; used && n < 4; ++n) {
                        const double before = *unknowns[i];
                        *unknowns[i] += sign * steps[i];
                        const double there = mount.damping < 0 ? everywhere : misfit(guess, mount);
                        if (!(there < best)) {
                            *unknowns[i] = before;
                            break;
                        }
                        best = there;
                    }
                }
                steps[i] /= 2;
            }
        }
        return guess;
    }

    const VibrationFit& fit() const { return fit_; }

    /// Returns the part of the found hop that is more probably the car's than the model's error.
    double trusted_hop(const Guess& guess) const {
        return guess.hop / (1 + std::pow(hop_error_sd / hop_sd_, 2));
    }

private:
    const VibrationFit& fit_;
    const Vehicle& vehicle_;
    double hop_sd_;
};

constexpr double min_speed_ratio = 1.1; // slowest to fastest

constexpr double shortest_wheelbase_m = 2.0;
constexpr double longest_wheelbase_m = 3.6;
constexpr double wheelbase_step_m = 0.1;
constexpr double other_wheelbase_m = 0.25; // this far from the best one is another one, ...
constexpr double surely_other = 8;         // ... and this much less likely, ...
constexpr double surely_other_part = 0.15; // ... and by this part of what no car explains

std::optional<Guess> with_axles(const Search& search) {
    Guess best;
    std::vector<std::pair<double, double>> misfits; // wheelbase, misfit
    double least = everywhere;
    for (double length_m = shortest_wheelbase_m; length_m < longest_wheelbase_m + 1e-6;
         length_m += wheelbase_step_m) {
        double least_here = everywhere;
        for (const double ahead : {0.0, 0.15, 0.3}) {
            for (const double hop : {-0.3, 0.3}) {
                const Guess guess{.wheelbase_m = length_m, .ahead = ahead, .hop = hop};
                const double here = search.misfit(guess);
                least_here = std::min(least_here, here);
                if (here < least) {
                    least = here;
                    best = guess;
                }
            }
        }
        misfits.emplace_back(length_m, least_here);
    }
    double least_other = everywhere;
    for (const auto& [length_m, misfit] : misfits) {
        if (std::abs(length_m - best.wheelbase_m) > other_wheelbase_m) {
            least_other = std::min(least_other, misfit);
        }
    }
    const bool inside = best.wheelbase_m > shortest_wheelbase_m + wheelbase_step_m / 2 &&
                        best.wheelbase_m < longest_wheelbase_m - wheelbase_step_m / 2;
    const bool sure = inside && least_other - least > surely_other + surely_other_part * least;
    return sure ? std::optional{best} : std::nullopt;
}

// Mounts that are sought: below, they would be the body's own motion or the engine on its
// bearings.
constexpr double lowest_mount_hz = 8;
constexpr double highest_mount_hz = 20;
constexpr double most_damped = 0.2;
constexpr double surely_a_mount = 12; // gain in the misfit

std::optional<Resonance> mount_of(const Search& search, Guess& guess, double highest_hz) {
    double least = everywhere;
    Resonance best;
    Guess with;
    for (const double hop : {-0.5, 0.0, 0.5}) {
        for (const double damping : {-0.4, 0.0, 0.4}) {
            Guess there = guess;
            there.hop += hop;
            there.damping += damping;
            const auto modelled = search.fit().modelled(search.car(there));
            for (double hz = lowest_mount_hz; hz <= highest_hz; hz += 0.5) {
                for (const double damped : {0.03, 0.06, 0.1, 0.16}) {
                    const double here =
                        search.fit().misfit(modelled, {hz, damped}) + search.unlikely(there);
                    if (here < least) {
                        least = here;
                        best = {hz, damped};
                        with = there;
                    }
                }
            }
        }
    }
    with = search.refined(with, best);
    Resonance none;
    guess = search.refined(guess, none);
    const double without = search.misfit(guess);
    const double gain = without - search.misfit(with, best);
    const double middle_mps = std::sqrt(search.fit().slowest_mps() * search.fit().fastest_mps());
    const auto car = search.fit().modelled(search.car(with));
    const auto car_alone = search.fit().modelled(search.car(guess));
    const auto gain_between = [&](double from_mps, double to_mps) {
        return search.fit().misfit(car_alone, {}, from_mps, to_mps) -
               search.fit().misfit(car, best, from_mps, to_mps);
    };
    const bool found = gain > surely_a_mount && best.hz > lowest_mount_hz && best.hz < highest_hz &&
                       best.damping < most_damped && gain_between(0, middle_mps) > 0 &&
                       gain_between(middle_mps, 1e9) > 0;
    if (!found) {
        return std::nullopt;
    }
    guess = with;
    return best;
}

/// Returns the damping at the best guess. Its standard deviation is that of the fit with the wheel
/// hop unknown, too, and of the stated damping, which friction is not told apart from.
ShownDamping damping_at(const Search& search,
                        const Guess& guess,
                        const Resonance& mount,
                        const VibrationSpectra& spectra,
                        double stated_sd) {
    constexpr double step = 0.1;
    const auto beside = [&](double hop, double damping) {
        Guess there = guess;
        there.hop += hop * step;
        there.damping += damping * step;
        return search.misfit(there, mount);
    };
    const double here = beside(0, 0);
    const double bend_hop = beside(1, 0) + beside(-1, 0) - 2 * here;
    const double bend = beside(0, 1) + beside(0, -1) - 2 * here;
    const double both = (beside(1, 1) + beside(-1, -1) - beside(1, -1) - beside(-1, 1)) / 4;
    // The misfit is twice the negative logarithm of the likelihood. What the prior adds to it holds
    // the damping back, and is taken off.
    const double all = (bend - both * both / std::max(bend_hop, 1e-9)) / (2 * step * step);
    const double prior = 1 / (damping_sd * damping_sd);
    const double shown = std::max(all - prior, least_shown * prior);
    const double log_ratio = guess.damping * (shown + prior) / shown;
    return {.added = std::expm1(log_ratio),
            .sd = std::exp(log_ratio) *
                  std::hypot(damping_error_sd, damping_fit_error / std::sqrt(shown), stated_sd),
            .inverse_strength = inverse_strength(spectra)};
}

bool is_enough(const VibrationFit& fit) {
    return !fit.empty() && fit.fastest_mps() > min_speed_ratio * fit.slowest_mps();
}

} // namespace

VibratingCar car_from_vibration(const VibrationSpectra& spectra, const Vehicle& vehicle) {
    VibratingCar found{.vehicle = vehicle, .mount = {}};
    found.vehicle.imu.noise_mps2 = sensor_noise_mps2(spectra, vehicle.imu.noise_mps2);
    const bool unknown_axles = is_class_of_cars(vehicle);
    Guess guess;
    if (unknown_axles) {
        const VibrationFit fit{spectra, found.vehicle.imu, spectra.has_pitch};
        if (!is_enough(fit)) {
            return found;
        }
        const auto axles = with_axles({fit, vehicle});
        found.found_axles = axles.has_value();
        guess = axles.value_or(guess);
    }
    const VibrationFit fit{
        spectra, found.vehicle.imu, spectra.has_pitch && (vehicle.axles || found.found_axles)};
    if (!is_enough(fit)) {
        return found;
    }
    const Search search{fit, vehicle};
    const double highest_hz =
        std::min(highest_mount_hz,
                 VibrationSpectra::first_hz +
                     VibrationSpectra::step_hz * static_cast<double>(spectra.used_bins) - 2);
    found.mount = mount_of(search, guess, highest_hz).value_or(Resonance{});
    if (found.mount.hz > 0) {
        found.vehicle.uncertainty["mount"] = mount_sd;
    }
    if ((vehicle.axles || found.found_axles) && !spectra.windows.empty()) {
        const double stated_sd =
            found.found_axles ? usual_damping_sd : uncertainty_of(vehicle, "cs_ns_per_m");
        found.damping = damping_at(search, guess, found.mount, spectra, stated_sd);
    }
    found.vehicle.half_car.kt_n_per_m *= std::exp(search.trusted_hop(guess));
    if (found.found_axles) {
        auto& car = found.vehicle;
        car.axles = search.car(guess).axles;
        car.imu.x_m = search.car(guess).imu.x_m;
        car.gain = 1;
        car.uncertainty.erase("is_kgm2"); // tracks are not told apart
        car.uncertainty.erase("l_m");
        car.uncertainty.erase("mu_kg");
        car.uncertainty["gain"] = holder_gain_sd;
        car.uncertainty["cs_ns_per_m"] = usual_damping_sd;
        car.uncertainty["dynamic_index"] = unstated_dynamic_index_sd;
        car.uncertainty[found_imu_x] = usual_ahead.sd;
    }
    return found;
}

} // namespace macadam
