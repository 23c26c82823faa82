#include "estimator/smoother/smoothed_iri.hpp"

#include "estimator/smoother/car/linear_car.hpp"
#include "estimator/smoother/friction.hpp"
#include "estimator/smoother/stretch_record.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t tuning_samples = 3000;
constexpr std::size_t min_tuning_samples = 1200;

constexpr auto roll_channel = static_cast<std::size_t>(Channel::roll_rate);

constexpr double untuned_sd = 0.1; // relative, of a car with too few data for tuning

// Error common to every IRI, from simulated cars: with known friction, and with estimated friction,
// including dampers, bars and bushes that a vehicle file does not describe
// (docs/method/smoother.md).
constexpr double known_car_part = 0.02;
constexpr double found_car_part = 0.04;
constexpr double random_part = 0.07; // of 1 m, independent from metre to metre
constexpr double indicative_common = 0.20;

constexpr int roll_rounds = 4; // for roll rate after the other channels, from their level

std::size_t sample_at(const DriveRecord& drive, double travel_m) {
    return static_cast<std::size_t>(std::ranges::lower_bound(drive.travel_m, travel_m) -
                                    drive.travel_m.begin());
}

bool is_felt(const DriveRecord& drive) {
    return std::ranges::any_of(drive.felt, [](const auto& felt) { return !felt.empty(); });
}

/// Appends the cells [from, to) of an estimate, counted on the grid.
void append(const std::vector<float>& cells,
            const RoadGrid& grid,
            std::ptrdiff_t from,
            std::ptrdiff_t to,
            std::vector<float>& onto) {
    for (std::ptrdiff_t cell = from; cell < to; ++cell) {
        onto.push_back(cells[static_cast<std::size_t>(cell - grid.first_cell)]);
    }
}

void append(const std::vector<std::vector<float>>& metres,
            const RoadGrid& grid,
            std::ptrdiff_t from_cell,
            std::ptrdiff_t to_cell,
            std::vector<std::vector<float>>& onto) {
    onto.resize(metres.size());
    const double cells_a_metre = 1 / grid.cell_m;
    const auto metre = [&](std::ptrdiff_t cell) {
        return static_cast<std::size_t>(static_cast<double>(cell - grid.first_cell) /
                                        cells_a_metre);
    };
    for (std::size_t road = 0; road < metres.size(); ++road) {
        const auto per_metre = static_cast<std::ptrdiff_t>(cells_a_metre);
        for (std::ptrdiff_t cell = from_cell; cell + per_metre <= to_cell; cell += per_metre) {
            const std::size_t at = std::min(metre(cell), metres[road].size() - 1);
            onto[road].push_back(metres[road][at]);
        }
    }
}

/// Appends the stations [from, to) of an estimate. Each piece has its own zero, so it is shifted to
/// continue the previous one.
void append(const RoadEstimate& estimate,
            std::ptrdiff_t from,
            std::ptrdiff_t to,
            EstimatedProfile& onto) {
    const auto put = [&](const std::vector<Pair>& road_m, double left, std::vector<float>& onto_m) {
        const auto height_m = [&](std::ptrdiff_t cell) {
            const std::ptrdiff_t at = std::max<std::ptrdiff_t>(0, cell - estimate.grid.first_cell);
            const auto& [mean, half] = road_m[static_cast<std::size_t>(at)];
            return mean + left * half;
        };
        const double raise_m =
            onto_m.empty() ? 0 : static_cast<double>(onto_m.back()) - height_m(from - 1);
        for (std::ptrdiff_t cell = from; cell < to; ++cell) {
            onto_m.push_back(static_cast<float>(height_m(cell) + raise_m));
        }
    };
    const auto put_both = [&](double left, auto& track_m, auto& error_m) {
        put(estimate.profile_m, left, track_m);
        put(estimate.perturbation_m, left, error_m);
    };
    if (estimate.felt.mean) {
        put_both(0, onto.centre_m, onto.centre_error_m);
    }
    if (estimate.felt.mean && estimate.felt.half) {
        put_both(+1, onto.left_m, onto.left_error_m);
        put_both(-1, onto.right_m, onto.right_error_m);
    }
}

/// Appends the rectified strokes of cells [from, to), and the headline's scatter.
void append(const RoadEstimate& estimate,
            std::ptrdiff_t from,
            std::ptrdiff_t to,
            bool tracks,
            IriRun& onto) {
    if (tracks && estimate.felt.half && estimate.felt.mean) {
        append(estimate.left_mm_per_m, estimate.grid, from, to, onto.left_mm_per_m);
        append(estimate.right_mm_per_m, estimate.grid, from, to, onto.right_mm_per_m);
        append(estimate.tracks_scatter, estimate.grid, from, to, onto.scatter_mm_per_m);
    } else {
        append(estimate.centre_scatter, estimate.grid, from, to, onto.scatter_mm_per_m);
    }
    append(estimate.centre_mm_per_m, estimate.grid, from, to, onto.centre_mm_per_m);
}

IriRun empty_run(const Stretch& stretch, const EstimatorConfig& config, double cell_m) {
    return {.start_travel_m = stretch.travel_m.empty() ? 0 : stretch.travel_m.front(),
            .cell_m = cell_m,
            .left_mm_per_m = {},
            .right_mm_per_m = {},
            .centre_mm_per_m = {},
            .speed_mps = {},
            .lead_in_m = config.lead_in_m,
            .indicative = false,
            .scatter_mm_per_m = {}};
}

double common_sd_of(const TunedCar& car, bool indicative) {
    const bool known = car.friction_sd_n == 0 && car.iri_sd == 0;
    return std::hypot(
        known ? known_car_part : found_car_part, car.iri_sd, indicative ? indicative_common : 0);
}

/// Returns the cells that both axles have passed, in whole metres.
std::pair<std::ptrdiff_t, std::ptrdiff_t> cells_under(const DriveRecord& drive, double cell_m) {
    const auto& car = drive.cars.front().car;
    const auto cells_a_metre = static_cast<std::ptrdiff_t>(std::lround(1 / cell_m));
    const double first_m = std::ceil(drive.travel_m.front() + car.front_m);
    const double last_m = std::floor(drive.travel_m.back() + car.rear_m);
    return {static_cast<std::ptrdiff_t>(first_m) * cells_a_metre,
            static_cast<std::ptrdiff_t>(last_m) * cells_a_metre};
}

/// Cells [from, to) of a run, and the samples [first, last) used to smooth them.
struct Piece {
    std::ptrdiff_t from, to;
    std::size_t first, last;
};

Piece piece_at(const DriveRecord& drive,
               std::ptrdiff_t from,
               std::ptrdiff_t end,
               double cell_m,
               const PieceConfig& config) {
    const auto& travel_m = drive.travel_m;
    const auto cells_a_metre = static_cast<std::ptrdiff_t>(std::lround(1 / cell_m));
    const double from_m = static_cast<double>(from) * cell_m;
    const std::size_t furthest =
        std::min(travel_m.size() - 1, sample_at(drive, from_m) + config.core_samples);
    const double until_m =
        std::min(from_m + config.core_m, std::max(from_m + 1, travel_m[furthest]));
    const std::size_t last =
        std::min(travel_m.size(), sample_at(drive, until_m + config.margin_m) + 1);
    const auto whole = static_cast<std::ptrdiff_t>(std::floor(until_m)) * cells_a_metre;
    const auto to =
        last == travel_m.size() ? end : std::clamp(whole, std::min(end, from + cells_a_metre), end);
    return {from, to, sample_at(drive, from_m - config.margin_m), last};
}

/// Returns whether roll rate serves HRI/MRI alone, beside channels that observe the mean of the
/// tracks.
bool is_roll_apart(const DriveRecord& drive, const EstimatorConfig& config) {
    return !config.tracks && !config.sensors && felt_by({&drive, 1}).mean &&
           !drive.felt[roll_channel].empty();
}

/// Adds half the difference of the tracks from roll rate. The blocks of a symmetric car have no
/// state in common, so it has a small filter of its own: the level, and the damping with friction,
/// are those found by the other channels.
RoadEstimate with_half(RoadEstimate estimate, VehicleDrive roll, SmootherConfig config) {
    config.rounds = roll_rounds;
    config.settling = roll_rounds - 1;
    roll.friction_n = 0; // of which the damping is known
    RoadEstimate begin;
    begin.level = estimate.level;
    begin.level.felt = {.mean = false, .half = true};
    begin.which = estimate.which;
    begin.noise.resize(1);
    const auto found = smooth_drives({std::move(roll)}, config, &begin);
    for (std::size_t i = 0; i < found.profile_m.size(); ++i) {
        estimate.profile_m[i].half = found.profile_m[i].half;
        estimate.perturbation_m[i].half = found.perturbation_m[i].half;
    }
    estimate.felt.half = true;
    return estimate;
}

RoadEstimate estimate_of(VehicleDrive drive, bool roll_apart, const SmootherConfig& config) {
    if (!roll_apart) {
        return smooth_drives({std::move(drive)}, config);
    }
    VehicleDrive roll = drive;
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        auto& without = channel == roll_channel ? drive.drive : roll.drive;
        without.felt[channel].clear();
        without.variance[channel].clear();
    }
    return with_half(smooth_drives({std::move(drive)}, config), std::move(roll), config);
}

/// Returns the damping shown by a trip as it is over samples [from, to), where the wheels hop more
/// or less than in the mean of the trip.
std::optional<ShownDamping> in_piece(std::optional<ShownDamping> damping,
                                     const Stretch& stretch,
                                     std::size_t from,
                                     std::size_t to) {
    const auto cut = [=](const std::vector<float>& values) {
        return std::vector<float>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                  values.begin() + static_cast<std::ptrdiff_t>(to));
    };
    if (!damping || stretch.vertical_mps2.empty()) {
        return std::nullopt;
    }
    Stretch piece{};
    piece.step_s = stretch.step_s;
    piece.vertical_mps2 = cut(stretch.vertical_mps2);
    piece.speed_mps = cut(stretch.speed_mps);
    VibrationSpectra spectra;
    add(spectra, piece);
    if (!spectra.windows.empty()) {
        const double here = inverse_strength(spectra);
        damping->added *= here / damping->inverse_strength;
        damping->sd *= here / damping->inverse_strength;
        damping->inverse_strength = here;
    }
    return damping;
}

} // namespace

TunedCar car_in(const Stretch& stretch,
                const VibratingCar& car,
                const EstimatorConfig& config,
                const std::stop_token& stop) {
    const auto& vehicle = car.vehicle;
    auto drive = drive_of(stretch, vehicle, config, car.mount);
    if (is_roll_apart(drive, config)) {
        drive.felt[roll_channel].clear();
        drive.variance[roll_channel].clear();
    }
    if (drive.travel_m.size() < min_tuning_samples || !is_felt(drive)) {
        return {.vehicle = vehicle,
                .friction_n =
                    vehicle.half_car.friction_n.value_or(usual_friction_n(vehicle.half_car).mean),
                .iri_sd = untuned_sd,
                .mount = car.mount};
    }
    const std::size_t count = std::min(drive.travel_m.size(), tuning_samples);
    const std::size_t from = (drive.travel_m.size() - count) / 2;
    Vehicle tunable = with_height(vehicle);
    if (drive.felt[0].empty() || drive.felt[3].empty()) {
        tunable.uncertainty.clear();
    }
    auto piece = piece_of(drive, from, from + count);
    piece.cars = {car_steps(linear_car(tunable), stretch.step_s)};
    auto tuned =
        tuned_car(piece, tunable, {}, in_piece(car.damping, stretch, from, from + count), stop);
    tuned.mount = car.mount;
    tuned.vehicle.imu.height_above_roll_axis_m = vehicle.imu.height_above_roll_axis_m;
    if (tunable.uncertainty.empty()) {
        tuned.iri_sd = std::hypot(tuned.iri_sd, untuned_iri_sd(vehicle, false));
    }
    return tuned;
}

CarOfTrip car_of_trip(const VibrationSpectra& spectra,
                      const Stretch& stretch,
                      const Vehicle& vehicle,
                      const EstimatorConfig& config,
                      const std::stop_token& stop) {
    const auto found = car_from_vibration(spectra, vehicle);
    auto of_found = config;
    if (found.found_axles && config.tracks && !config.sensors) {
        of_found.sensors = SensorSet{.vertical = true, .pitch = true, .yaw = true};
    }
    auto car = car_in(stretch, found, of_found, stop);
    return {std::move(car), of_found};
}

bool uses_vertical(const EstimatorConfig& config) {
    return config.channels != Channels::lateral && (!config.sensors || config.sensors->vertical);
}

IriRun smoothed_iri(const Stretch& stretch,
                    const TunedCar& car,
                    const EstimatorConfig& config,
                    const PieceConfig& pieces,
                    const Progress& progress) {
    SmootherConfig smoother;
    auto drive = drive_of(stretch, car.vehicle, config, car.mount);
    IriRun run = empty_run(stretch, config, smoother.cell_m);
    if (!is_felt(drive) || drive.travel_m.size() < 3) {
        return run;
    }
    const Vehicle vehicle = with_height(car.vehicle);
    drive.cars = cars_with_friction(vehicle, stretch.step_s);
    run.indicative = !felt_by({&drive, 1}).mean;
    run.common_sd = common_sd_of(car, run.indicative);
    run.random_sd = random_part;

    const auto [begin, end] = cells_under(drive, smoother.cell_m);
    run.start_travel_m = static_cast<double>(begin) * smoother.cell_m;
    run.profile = {.start_travel_m = run.start_travel_m, .step_m = smoother.cell_m};
    for (auto cell = begin; cell < end && !progress.stop.stop_requested();) {
        const auto piece = piece_at(drive, cell, end, smoother.cell_m, pieces);
        const auto estimate =
            estimate_of({piece_of(drive, piece.first, piece.last), vehicle, car.friction_n},
                        is_roll_apart(drive, config),
                        smoother);
        append(estimate, piece.from, piece.to, config.tracks || config.sensors, run);
        if (!vehicle.axles) {
            run.scatter_mm_per_m.clear(); // it excludes what one axle misses
        }
        if (config.profile) {
            append(estimate, piece.from, piece.to, run.profile);
        }
        cell = piece.to;
        progress(static_cast<std::size_t>(cell - begin), static_cast<std::size_t>(end - begin));
    }
    for (std::size_t i = 0; i < run.centre_mm_per_m.size(); ++i) {
        const double at_m = run.start_travel_m + (static_cast<double>(i) + 0.5) * run.cell_m;
        const std::size_t k = std::min(sample_at(drive, at_m), stretch.speed_mps.size() - 1);
        run.speed_mps.push_back(stretch.speed_mps[k]);
    }
    return run;
}

} // namespace macadam
