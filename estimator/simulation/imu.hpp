#pragma once

#include "estimator/simulation/car_model.hpp"
#include "estimator/simulation/random.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {

/// Planar motion of the car at one time.
struct MotionNow {
    double travel_m, speed_mps, acc_mps2, yaw_rate_radps, yaw_acc_radps2;
};

/// Specific force (x forward, y left, z up) and rates of turn at a point fixed in the body.
using InertialSignals = std::array<double, 6>;

/// Computes rigid-body kinematics at the sensor's position, for small angles of pitch and roll.
InertialSignals inertial_signals_at(const ImuMount& place,
                                    const CarState& state,
                                    const Coordinates& acceleration,
                                    const MotionNow& motion);

/// Simulated inertial sensor: `sense` is called at every simulation step, `read` takes a sample.
class Imu {
public:
    /// \throws InputError  if a parameter of the recipe is out of its range.
    Imu(const ImuRecipe& recipe, double step_s, std::uint64_t seed);

    void sense(const InertialSignals& signals); ///< rotates to the sensor's axes and low-passes
    void read(double t_s, ImuReadings& into);

private:
    /// y = b0 x + b1 x[-1] + b2 x[-2] - a1 y[-1] - a2 y[-2], transposed direct form II.
    struct Section {
        double b0, b1, b2, a1, a2;
        std::size_t channels; ///< 3: the accelerations, 6: all
        InertialSignals later{}, latest{};
    };

    static std::vector<Section> lowpass(int order, double corner_hz, double step_s);
    static Section mount(double hz, double damping, double step_s);

    ImuRecipe recipe_;
    std::array<std::array<double, 3>, 3> to_sensor_;
    std::vector<Section> sections_;
    Random random_;
    InertialSignals sensed_{};
};

} // namespace macadam
