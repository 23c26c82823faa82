#include "worlds.hpp"

#include "estimator/smoother/smoothed_iri.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>

namespace macadam::testing {
namespace {

constexpr std::array all_worlds{
    World{"waviness 1.6, MRI 2",
          {.iri_mm_per_m = 2, .waviness = 1.6},
          {.wheelbase_m = 2.4, .cg_to_front_m = 1.1, .dynamic_index = 0.95, .rear_ratio = 1.1},
          0.3},
    World{"joints of 5 m, MRI 2",
          {.iri_mm_per_m = 2, .joint_spacing_m = 5, .joint_step_mm = 1.5},
          {.wheelbase_m = 2.6, .cg_to_front_m = 1.2, .dynamic_index = 1.05, .rear_ratio = 0.9},
          0.5},
    World{"waviness 2.6, MRI 1",
          {.iri_mm_per_m = 1, .waviness = 2.6},
          {.wheelbase_m = 3.3, .cg_to_front_m = 1.6, .dynamic_index = 1.0, .rear_ratio = 1.25},
          0.9},
    World{"waviness 2, MRI 6",
          {.iri_mm_per_m = 6, .waviness = 2},
          {.wheelbase_m = 2.95, .cg_to_front_m = 1.45, .dynamic_index = 1.1, .rear_ratio = 1.0},
          0},
    World{"20 patches and 2 potholes a km, MRI 3.5",
          {.iri_mm_per_m = 3.5, .patches_per_km = 20, .potholes_per_km = 2},
          {.wheelbase_m = 2.8, .cg_to_front_m = 1.3, .dynamic_index = 0.9, .rear_ratio = 1.2},
          -0.7},
    World{"changing slowly, MRI 2.5",
          {.iri_mm_per_m = 2.5, .level_sd = 0.6},
          {.wheelbase_m = 2.7, .cg_to_front_m = 1.25, .dynamic_index = 1.0, .rear_ratio = 1.1},
          -0.3},
};

} // namespace

std::span<const World> worlds() {
    return all_worlds;
}

double drive_length_m() {
    return std::getenv("MACADAM_TEST_ALL") != nullptr ? 10000 : 1200;
}

DriveRecipe drive_in(const World& world, double speed_kmh) {
    auto car = two_axle_car(world.axles, world.imu_ahead_m);
    car.half_car.friction_n = 0; // as linear_car_of() has it
    return {.road = world.road,
            .car = linear_car_of(car),
            .length_m = drive_length_m(),
            .speed_kmh = speed_kmh,
            .seed = 11};
}

IriRun smoothed(const Stretch& stretch, const Vehicle& vehicle, const SensorSet& sensors) {
    EstimatorConfig config;
    config.method = Method::smoother;
    config.sensors = sensors;
    return smoothed_iri(stretch, car_in(stretch, {.vehicle = vehicle}, config), config);
}

IriRun filtered(const Stretch& stretch, const Vehicle& vehicle, Channels channels) {
    EstimatorConfig config;
    config.method = Method::kf;
    config.channels = channels;
    return estimate_iri(stretch, vehicle, config);
}

void append(std::vector<Held>& set, const std::vector<Held>& pieces) {
    const auto drive = relative(pieces);
    set.insert(set.end(), drive.begin(), drive.end());
}

void print(const char* what, double speed_kmh, const std::vector<Held>& pieces) {
    const auto errors = errors_of(pieces);
    std::printf(
        "%-44s %3.0f km/h: bias %+5.1f %%, RMSE %5.2f %%, interval covers %3.0f %% of %zu\n",
        what,
        speed_kmh,
        100 * errors.bias,
        100 * errors.rmse,
        100 * errors.covered,
        pieces.size());
}

} // namespace macadam::testing
