#include "estimator/roughness/roughness_trace.hpp"

#include "estimator/iri/iri.hpp"
#include "estimator/motion/butterworth.hpp"
#include "estimator/roughness/unknown_input_filter.hpp"
#include "estimator/vehicle/half_car.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

// Corner frequencies of the paper (sections VI-A and VI-B). It does not state orders; used here:
// fourth-order low-pass and second-order high-pass, both run forward and backward.
constexpr double vertical_lowpass_hz = 13;
constexpr double lateral_lowpass_hz = 11;
constexpr double lateral_highpass_hz = 0.5;
constexpr int lowpass_order = 4;
constexpr int highpass_order = 2;
constexpr double settle_periods = 3; // of a filter's corner: the reflection covers its ringing

constexpr double grid_m = 0.05; // the tyre's 250 mm are exactly five steps

/// Elevations of the method's tracks at increasing travel.
struct Profiles {
    std::vector<double> travel_m;
    std::vector<std::vector<double>> tracks_m;
};

std::vector<double> passed(const std::vector<Section>& sections,
                           std::span<const double> signal,
                           double corner_hz,
                           double rate_hz) {
    return zero_phase(
        sections, signal, static_cast<std::size_t>(settle_periods * rate_hz / corner_hz));
}

/// Converts the channel to the model's units: filtered as in the paper and divided by the gain.
std::vector<double> vertical_input(const Stretch& stretch, double gain, bool filters) {
    std::vector<double> signal(stretch.vertical_mps2.begin(), stretch.vertical_mps2.end());
    std::ranges::for_each(signal, [=](double& y) { y /= gain; });
    const double rate_hz = 1 / stretch.step_s;
    if (!filters || 2 * vertical_lowpass_hz >= rate_hz) {
        return signal;
    }
    return passed(butterworth_lowpass(lowpass_order, vertical_lowpass_hz, rate_hz),
                  signal,
                  vertical_lowpass_hz,
                  rate_hz);
}

std::vector<double> lateral_input(const Stretch& stretch, double gain, bool filters) {
    std::vector<double> signal(stretch.lateral_mps2.begin(), stretch.lateral_mps2.end());
    std::ranges::for_each(signal, [=](double& y) { y /= gain; });
    if (!filters) {
        return signal;
    }
    const double rate_hz = 1 / stretch.step_s;
    signal = passed(butterworth_highpass(highpass_order, lateral_highpass_hz, rate_hz),
                    signal,
                    lateral_highpass_hz,
                    rate_hz);
    if (2 * lateral_lowpass_hz >= rate_hz) {
        return signal;
    }
    return passed(butterworth_lowpass(lowpass_order, lateral_lowpass_hz, rate_hz),
                  signal,
                  lateral_lowpass_hz,
                  rate_hz);
}

/// Returns true if the lateral acceleration contains bends. They contribute gravity and centripetal
/// acceleration, which the lateral half-car interprets as a road of decimetres: on simulated
/// streets its IRI was three times the truth. Bends are slow and road roll is fast: on a recorded
/// straight highway the power below 1 Hz was 0.06 to 0.1 of that above.
bool shows_bends(const Stretch& stretch) {
    constexpr double slow_hz = 1;
    const double rate_hz = 1 / stretch.step_s;
    const std::vector<double> felt(stretch.lateral_mps2.begin(), stretch.lateral_mps2.end());
    const auto signal = passed(butterworth_highpass(highpass_order, lateral_highpass_hz, rate_hz),
                               felt,
                               lateral_highpass_hz,
                               rate_hz);
    const auto slow =
        passed(butterworth_lowpass(lowpass_order, slow_hz, rate_hz), signal, slow_hz, rate_hz);
    double slow_power = 0;
    double quick_power = 0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
        slow_power += slow[i] * slow[i];
        quick_power += (signal[i] - slow[i]) * (signal[i] - slow[i]);
    }
    constexpr double straight_share = 0.1;
    return slow_power > straight_share * quick_power;
}

Channels choose(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config) {
    const bool vertical = !stretch.vertical_mps2.empty();
    const bool lateral = !stretch.lateral_mps2.empty();
    switch (config.channels) {
    case Channels::automatic:
        if (config.tracks && vertical && lateral && vehicle.imu.height_above_roll_axis_m > 0 &&
            !shows_bends(stretch)) {
            return Channels::both;
        }
        return vertical ? Channels::vertical : Channels::lateral;
    case Channels::both:
        return !vertical ? Channels::lateral : !lateral ? Channels::vertical : Channels::both;
    case Channels::vertical:
    case Channels::lateral:
        break;
    }
    return config.channels;
}

/// Returns the filter's inputs by track. The estimate at sample k holds from the previous sample,
/// so it represents the road midway between the two; the first sample has no such road.
template <int States, int Inputs, int Outputs>
Profiles run(const LinearSystem<States, Inputs, Outputs>& system,
             const std::array<std::vector<double>, Outputs>& measured,
             const Stretch& stretch,
             double q_over_r) {
    UnknownInputFilter<States, Inputs, Outputs> filter{discretise(system, stretch.step_s),
                                                       q_over_r};
    const std::size_t count = stretch.travel_m.size();
    Profiles profiles{.travel_m = std::vector<double>(count - 1),
                      .tracks_m = std::vector(Inputs, std::vector<double>(count - 1))};
    for (std::size_t k = 0; k < count; ++k) {
        Eigen::Vector<double, Outputs> y;
        for (int i = 0; i < Outputs; ++i) {
            y[i] = measured[static_cast<std::size_t>(i)][k];
        }
        const auto road = filter.push(y);
        if (k > 0) {
            profiles.travel_m[k - 1] = (stretch.travel_m[k - 1] + stretch.travel_m[k]) / 2;
            for (int i = 0; i < Inputs; ++i) {
                profiles.tracks_m[static_cast<std::size_t>(i)][k - 1] = road[i];
            }
        }
    }
    return profiles;
}

Profiles profiles_of(const Stretch& stretch,
                     const Vehicle& vehicle,
                     const EstimatorConfig& config,
                     Channels channels) {
    const double height_m = vehicle.imu.height_above_roll_axis_m;
    if (channels == Channels::vertical) {
        return run<4, 1, 1>(quarter_car(vehicle.half_car),
                            {vertical_input(stretch, gain_for_one_axle(vehicle), config.filters)},
                            stretch,
                            config.q_over_r);
    }
    auto lateral = lateral_input(stretch, gain_for_one_axle(vehicle), config.filters);
    if (channels == Channels::lateral) {
        auto profiles = run<8, 2, 1>(lateral_half_car(vehicle.half_car, height_m),
                                     {std::move(lateral)},
                                     stretch,
                                     config.q_over_r);
        profiles.tracks_m.pop_back(); // the other track is its mirror image
        return profiles;
    }
    auto profiles = run<8, 2, 2>(
        half_car(vehicle.half_car, height_m),
        {vertical_input(stretch, gain_for_one_axle(vehicle), config.filters), std::move(lateral)},
        stretch,
        config.q_over_r);
    auto& tracks = profiles.tracks_m;
    tracks.emplace_back(tracks[0].size());
    std::ranges::transform(
        tracks[0], tracks[1], tracks[2].begin(), [](double l, double r) { return (l + r) / 2; });
    return profiles;
}

/// Interpolates (x, y) linearly at start + i * step. x increases.
template <typename Values>
std::vector<double> resampled(
    const std::vector<double>& x, const Values& y, double start, double step, std::size_t count) {
    std::vector<double> out(count);
    std::size_t piece = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = start + static_cast<double>(i) * step;
        while (piece + 2 < x.size() && x[piece + 1] <= at) {
            ++piece;
        }
        const double run = x[piece + 1] - x[piece];
        const double part = run > 0 ? std::clamp((at - x[piece]) / run, 0.0, 1.0) : 0;
        const auto before = static_cast<double>(y[piece]);
        out[i] = before + part * (static_cast<double>(y[piece + 1]) - before);
    }
    return out;
}

std::vector<float>
cell_means(const std::vector<float>& values, std::size_t per_cell, double factor) {
    std::vector<float> means(values.size() / per_cell);
    for (std::size_t cell = 0; cell < means.size(); ++cell) {
        double sum = 0;
        for (std::size_t i = 0; i < per_cell; ++i) {
            sum += static_cast<double>(values[cell * per_cell + i]);
        }
        means[cell] = static_cast<float>(factor * sum / static_cast<double>(per_cell));
    }
    return means;
}

/// Returns the tracks as left, right and their mean, or the mean alone.
EstimatedProfile profile_of(std::vector<std::vector<float>> tracks_m, double start_travel_m) {
    EstimatedProfile profile{.start_travel_m = start_travel_m, .step_m = grid_m};
    profile.centre_m = std::move(tracks_m.back());
    if (tracks_m.size() == 3) {
        profile.left_m = std::move(tracks_m[0]);
        profile.right_m = std::move(tracks_m[1]);
    }
    return profile;
}

/// Returns the distance from the centre of gravity forward to the single axle of the models.
double axle_ahead_m(const Vehicle& vehicle) {
    return vehicle.axles ? vehicle.axles->cg_to_front_m - vehicle.axles->wheelbase_m / 2 : 0;
}

} // namespace

std::string name_of_validity(std::uint8_t flags) {
    constexpr std::pair<std::uint8_t, const char*> names[] = {{validity::too_slow, "too_slow"},
                                                              {validity::start_up, "start_up"},
                                                              {validity::gap, "gap"},
                                                              {validity::indicative, "indicative"}};
    std::string joined;
    for (const auto& [flag, name] : names) {
        if ((flags & flag) != 0) {
            joined.append(joined.empty() ? "" : "|").append(name);
        }
    }
    if (joined.empty()) {
        joined.append("ok");
    }
    return joined;
}

IriRun estimate_iri(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config) {
    const auto channels = choose(stretch, vehicle, config);
    const std::size_t per_cell = std::max<std::size_t>(1, std::lround(config.cell_m / grid_m));
    IriRun run{.start_travel_m = stretch.travel_m.empty() ? 0 : stretch.travel_m.front(),
               .cell_m = static_cast<double>(per_cell) * grid_m,
               .left_mm_per_m = {},
               .right_mm_per_m = {},
               .centre_mm_per_m = {},
               .speed_mps = {},
               .lead_in_m = config.lead_in_m,
               .indicative = channels == Channels::lateral,
               .scatter_mm_per_m = {}};
    const bool sampled = channels == Channels::lateral ? !stretch.lateral_mps2.empty()
                                                       : !stretch.vertical_mps2.empty();
    if (!sampled || stretch.travel_m.size() < 3) {
        return run;
    }

    const auto profiles = profiles_of(stretch, vehicle, config, channels);
    const double first_m = profiles.travel_m.front();
    const auto count = static_cast<std::size_t>((profiles.travel_m.back() - first_m) / grid_m) + 1;
    if (count < 2) {
        return run;
    }
    run.start_travel_m = first_m + axle_ahead_m(vehicle);
    const double factor = run.indicative ? config.lateral_regression : 1;
    std::vector<std::vector<float>> cells;
    std::vector<std::vector<float>> kept_m;
    for (const auto& track_m : profiles.tracks_m) {
        const auto even_m = resampled(profiles.travel_m, track_m, first_m, grid_m, count);
        if (config.profile && !run.indicative) {
            kept_m.emplace_back(even_m.begin(), even_m.end());
        }
        cells.push_back(cell_means(rectified_stroke_mm_per_m(even_m, grid_m), per_cell, factor));
    }
    const auto speeds = resampled(stretch.travel_m,
                                  stretch.speed_mps,
                                  first_m + run.cell_m / 2,
                                  run.cell_m,
                                  cells.front().size());
    run.speed_mps.assign(speeds.begin(), speeds.end());
    if (cells.size() == 3) {
        run.left_mm_per_m = std::move(cells[0]);
        run.right_mm_per_m = std::move(cells[1]);
    }
    run.centre_mm_per_m = std::move(cells.back());
    if (!kept_m.empty()) {
        run.profile = profile_of(std::move(kept_m), run.start_travel_m);
    }
    return run;
}

} // namespace macadam
