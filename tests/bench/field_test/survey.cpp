#include "survey.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam::field_test {
namespace {

constexpr double lane_m = 4000;
constexpr double keep_off_begin_m = 200;
constexpr double keep_off_end_m = 100;

/// An error that wanders: first-order Gauss-Markov along the road.
class Wander {
public:
    Wander(double sd_m, double length_m, std::uint64_t seed)
        : sd_m_{sd_m}, length_m_{length_m}, random_{seed}, at_{sd_m * normal_(random_)} {}

    double after(double step_m) {
        const double keep = std::exp(-step_m / length_m_);
        at_ = keep * at_ + std::sqrt(1 - keep * keep) * sd_m_ * normal_(random_);
        return at_;
    }

private:
    double sd_m_, length_m_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_{0, 1};
    double at_;
};

// Drivers hold their place in the lane within a few decimetres, for seconds.
constexpr double place_in_lane_sd_m = 0.15;
constexpr double place_in_lane_length_m = 200;

// Open service of satellites: 4 m (95 %) an axis, each receiver, and the two differ.
constexpr double satellite_sd_m = 2.0 * 1.41;
constexpr double satellite_length_m = 400;

// The axle of an A6 e-tron: tyres run nearer to the lane's middle than the paper's l = 1 m.
constexpr double half_track_m = 0.81;

struct Class {
    double iri_mm_per_m;
    double level_sd;
    double joint_spacing_m, patches_per_km, potholes_per_km;
    std::array<double, 4> speeds_kmh;
};

// Aimed at the middle of what each band needs; the worse a road, the more of it is damage.
constexpr std::array classes{Class{1.2, 0.3, 0, 1, 0, {110, 90, 80, 70}},
                             Class{2.7, 0.25, 0, 6, 0.2, {90, 70, 60, 50}},
                             Class{4.8, 0.2, 0, 12, 0.5, {70, 60, 50, 50}},
                             Class{7.5, 0.2, 0, 20, 1, {50, 50, 40, 40}}};
constexpr std::array wavinesses{1.8, 2.0, 2.2, 2.5};

RoadSurface surface_of(const LanePlan& plan) {
    const auto& kind = classes[plan.band];
    const RoadRecipe recipe{.iri_mm_per_m =
                                kind.iri_mm_per_m *
                                (0.8 + 0.1 * static_cast<double>((plan.number * 7) % 5)),
                            .waviness = wavinesses[plan.number % wavinesses.size()],
                            .level_sd = kind.level_sd,
                            .joint_spacing_m = plan.number % 10 == 3 ? 5.0 : 0.0,
                            .joint_step_mm = 0.5,
                            .patches_per_km = kind.patches_per_km,
                            .potholes_per_km = kind.potholes_per_km};
    return make_surface(recipe, lane_m, 7000 + plan.number);
}

/// The two tracks that a car of this width drives, wandering in the lane.
WheelPaths driven_paths(const RoadSurface& surface, double half_m, std::uint64_t seed) {
    Wander place{place_in_lane_sd_m, place_in_lane_length_m, seed};
    const std::size_t count = surface.elevation_m.front().size();
    WheelPaths paths{.step_m = surface.step_m, .left_m = {}, .right_m = {}};
    // Smooth from one anchor to the next, for a car does not jump sideways.
    constexpr std::size_t anchor_steps = 400;
    double before_m = place.after(1e6);
    double next_m = before_m;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % anchor_steps == 0) {
            before_m = next_m;
            next_m = place.after(anchor_steps * surface.step_m);
        }
        const double t = static_cast<double>(i % anchor_steps) / anchor_steps;
        const double middle_m = before_m + (next_m - before_m) * t * t * (3 - 2 * t);
        const double station_m = surface.step_m * static_cast<double>(i);
        paths.left_m.push_back(elevation_m(surface, station_m, middle_m + half_m));
        paths.right_m.push_back(elevation_m(surface, station_m, middle_m - half_m));
    }
    return paths;
}

std::vector<ReferencePiece> survey_of(const RoadSurface& surface, std::uint64_t number) {
    const auto truth = testing::true_stroke(driven_paths(surface, wheel_path_m, 100000 + number));
    Wander satellites{satellite_sd_m, satellite_length_m, 200000 + number};
    std::vector<ReferencePiece> pieces;
    for (double from_m = keep_off_begin_m; from_m + segment_m < lane_m - keep_off_end_m;
         from_m += segment_m) {
        pieces.push_back(
            {from_m,
             testing::true_over(truth, testing::Index::mri, from_m, from_m + segment_m),
             satellites.after(segment_m)});
    }
    return pieces;
}

/// The car as it is: the file's parameters within a few per cent, and what no file states.
CarRecipe true_car() {
    CarRecipe car{.vehicle = stated_car()};
    auto& half = car.vehicle.half_car;
    half.ms_kg *= 1.04; // driver, passenger and luggage
    half.cs_ns_per_m *= 0.95;
    half.ks_n_per_m *= 1.03;
    half.kt_n_per_m *= 0.97;
    car.antiroll_n_per_m = half.antiroll_n_per_m;
    return car;
}

} // namespace

std::size_t band_of(double reference_mm_per_m) {
    const auto band = std::ranges::find_if(bands, [&](const Band& b) {
        return reference_mm_per_m >= b.from_mm_per_m && reference_mm_per_m < b.to_mm_per_m;
    });
    return static_cast<std::size_t>(band - bands.begin());
}

std::vector<LanePlan> plan_of(double share) {
    std::array<long, bands.size()> open{};
    for (std::size_t band = 0; band < bands.size(); ++band) {
        open[band] = std::lround(share * bands[band].km * 1000 / segment_m);
    }
    std::vector<LanePlan> plans;
    // The roughest first: their smoother pieces belong to the bands below.
    for (std::size_t band = bands.size(); band-- > 0;) {
        while (open[band] > 0) {
            LanePlan plan{.number = plans.size(), .band = band, .counted = {}};
            const auto pieces = survey_of(surface_of(plan), plan.number);
            for (std::size_t i = 0; i < pieces.size(); ++i) {
                const auto of = band_of(pieces[i].reference_mm_per_m);
                if (of < bands.size() && open[of] > 0) {
                    --open[of];
                    plan.counted.push_back(i);
                }
            }
            plans.push_back(std::move(plan));
        }
    }
    return plans;
}

Lane lane_of(const LanePlan& plan) {
    const auto surface = surface_of(plan);
    const auto paths = driven_paths(surface, half_track_m, 300000 + plan.number);
    const auto all = survey_of(surface, plan.number);
    Lane lane{.drive = {.road = {},
                        .car = true_car(),
                        .imu = {.rate_hz = 50,
                                .noise_mps2 = 0.05,
                                .noise_radps = 0.002,
                                .lowpass_hz = 40},
                        .length_m = lane_m,
                        .speed_kmh = classes[plan.band].speeds_kmh[(plan.number / 4) % 4],
                        .imu_seed = 400000 + plan.number},
              .under_car = {.step_m = paths.step_m,
                            .left_m = {paths.left_m.begin(), paths.left_m.end()},
                            .right_m = {paths.right_m.begin(), paths.right_m.end()}},
              .driven = testing::true_stroke(paths),
              .pieces = {}};
    for (const std::size_t i : plan.counted) {
        lane.pieces.push_back(all[i]);
    }
    return lane;
}

Vehicle stated_car() {
    const Vehicle& published = *built_in_vehicle("audi-a6-etron");
    // Table III folds the sensor's height into I_s; apart, with a usual height, it is this.
    constexpr double height_m = 0.4;
    Vehicle car{.name = "a6-on-two-axles",
                .gain = 1,
                .one_axle_gain = {},
                .half_car = published.half_car,
                .axles =
                    Axles{.wheelbase_m = 2.946, .cg_to_front_m = 1.47}, // data sheet; half of it
                .imu = {.x_m = 0.2, .height_above_roll_axis_m = height_m, .noise_mps2 = 0.05},
                .uncertainty = {}};
    car.half_car.is_kgm2 *= height_m;
    car.half_car.l_m = half_track_m;
    car.half_car.antiroll_n_per_m = 8000;
    for (const char* parameter : {"ms_kg", "ks_n_per_m", "cs_ns_per_m", "kt_n_per_m", "is_kgm2"}) {
        car.uncertainty[parameter] = 0.05;
    }
    return car;
}

} // namespace macadam::field_test
