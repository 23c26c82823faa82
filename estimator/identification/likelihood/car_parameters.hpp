#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <Eigen/Core>

#include <string_view>
#include <vector>

namespace macadam {

/// Car of the likelihood fit: a vehicle with its friction, and properties that a vehicle file does
/// not hold.
struct FittedCar {
    Vehicle vehicle; ///< with axles; half_car.friction_n is set

    /// Excess of rebound over bump damping, relative to their mean. Dampers of passenger cars
    /// rebound up to three times as hard as they bump (J. C. Dixon, "The Shock Absorber Handbook",
    /// 2nd ed. 2007, section 1.8), hence 0 to 0.5.
    double rebound_excess;

    /// Length over which the road is smoothed, in the filter 1 / (1 + (2 pi length / wave)^2): by
    /// the contact of the tyres, and because the wheels do not run exactly in the measured tracks.
    double smoothing_m;

    /// Speed of a suspension's stroke below which its friction acts as a viscous force: motion that
    /// the model does not know, of waves beside the measured track, smooths the change of sign.
    double slip_mps;

    /// Height of the centre of gravity above the axes about which the body pitches and rolls: its
    /// weight tilts a tilted body further.
    double pitch_arm_m, roll_arm_m;
};

/// Parameter of the fit. It is moved from 0, its value in the file.
struct CarParameter {
    std::string_view name; ///< of the field
    double& (*in)(FittedCar&);
    bool in_file;     ///< a vehicle file has this field
    bool logarithmic; ///< moves are of the logarithm, else of the value
    double prior_sd;  ///< of the move
    double model_sd;  ///< of the move that a fit finds, from what the model simplifies
};

/// Returns the car as it is expected before the drive: the vehicle with dry friction, if the file
/// states none.
FittedCar expected_car(const Vehicle& vehicle);

/// Returns the parameters that a fit may move, with their stated uncertainty. Those without one get
/// that of the built-in classes of cars, since files seldom state it; mass, width and centre of
/// gravity are then held, as the paper does.
///
/// \param rolls  whether a channel observes the difference of the tracks: without one, the
///               parameters of roll are held.
std::vector<CarParameter> parameters_of(const Vehicle& vehicle, bool rolls);

/// Returns the car with all parameters moved. Values stay within physical limits. Roll inertia and
/// anti-roll bar keep their ratio to the mass where they are held, since readings and roughness
/// depend on that ratio.
FittedCar
moved(FittedCar car, const std::vector<CarParameter>& parameters, const Eigen::VectorXd& by);

} // namespace macadam
