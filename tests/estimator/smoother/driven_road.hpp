#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/simulation/road_surface.hpp"
#include "estimator/simulation/simulated_car.hpp"
#include "estimator/smoother/joint_smoother.hpp"

#include <vector>

namespace macadam::testing {

/// A car that is what its vehicle says and nothing else: no friction, even dampers, round wheels.
CarRecipe linear_car_of(const Vehicle& vehicle);

/// A passenger car of 1,500 kg with the axles and the sensor given, gain 1.
Vehicle two_axle_car(const Axles& axles, double imu_ahead_m);

/// One drive over one simulated road.
struct DriveRecipe {
    RoadRecipe road;
    CarRecipe car;
    ImuRecipe imu{.rate_hz = 50, .noise_mps2 = 0.05, .noise_radps = 0.002};
    double length_m = 3000;
    double speed_kmh = 80;
    double speed_swing = 0.08;  ///< relative, up and down within half a minute
    double right_over_left = 1; ///< roughness of the tracks; 1: the road's own
    std::uint64_t seed = 1;     ///< of the road
    std::uint64_t imu_seed = 1; ///< of the sensor's noise
};

/// Rectified stroke of the golden car over the true tracks, mm/m: E1926 of any part is its mean.
struct TrueStroke {
    double step_m;
    std::vector<float> left, right, centre;
    double kurtosis; ///< of the stroke before it is rectified, mean of both tracks
};
TrueStroke true_stroke(const WheelPaths& paths);

struct DrivenRoad {
    Stretch stretch; ///< every channel
    TrueStroke truth;
};
DrivenRoad driven_road(const DriveRecipe& recipe);

/// The same with a motion that is given; the recipe's speed is not used.
DrivenRoad driven_road(const DriveRecipe& recipe, const Motion& motion);

/// What the recipe's car feels of tracks that are given; the recipe's road is not used.
Stretch stretch_over(const RoadUnderWheels& road, const DriveRecipe& recipe);

enum class Index : std::uint8_t { left, right, mri, hri };

double true_over(const TrueStroke& truth, Index index, double from_m, double to_m);

/// The stretch with some of its channels alone.
struct Sensors {
    bool vertical = true, lateral = true, roll = true, pitch = true;
};
Stretch with_sensors(Stretch stretch, const Sensors& sensors);

/// A stretch as joint smoothing takes it, of a car that is known exactly.
VehicleDrive exact_drive(const Stretch& stretch, const Vehicle& vehicle);

/// A piece of road: what was said of it and what is true, mm/m.
struct Held {
    double estimate, truth;
    double sd = 0; ///< as stated
};

/// Pieces of one length, from behind the lead-in until near the end, where the estimate is `ok`
/// but for being indicative. HRI / 0.91 stands for an MRI where the tracks were not observed.
std::vector<Held> held_beside(const IriRun& run,
                              const TrueStroke& truth,
                              Index index,
                              double segment_m,
                              const Vehicle& vehicle);

/// The same of a joint estimate, which knows no lead-in.
std::vector<Held> held_beside(const RoadEstimate& road, const TrueStroke& truth, double segment_m);

/// Each divided by the mean truth of all, so that roads of different roughness count alike.
std::vector<Held> relative(std::vector<Held> pieces);

struct Errors {
    double bias, rmse; ///< over the mean truth
    double covered;    ///< share within 1.645 stated standard deviations
};
Errors errors_of(const std::vector<Held>& pieces);

/// The estimates times the one factor with which they come nearest to the truth.
std::vector<Held> with_best_gain(std::vector<Held> pieces);

} // namespace macadam::testing
