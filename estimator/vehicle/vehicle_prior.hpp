#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Lowest and highest value that is accepted.
struct ValueRange {
    double min;
    double max;
    bool contains(double value) const { return value >= min && value <= max; }
};

/// Kind of passenger car, with what is usual for it.
struct BodyType {
    std::string_view name;
    ValueRange mass_kg; ///< kerb mass of any such car
    ValueRange wheelbase_m;
    double bounce_hz;      ///< natural frequency of the body on its springs and tyres
    double half_track_m;   ///< half the track width
    double front_share;    ///< of the mass, on the front axle
    double unsprung_share; ///< of the kerb mass, all four wheels
};

/// Returns small, compact, saloon, estate, suv, van and pickup.
std::span<const BodyType> body_types();

/// Size of a tyre as on its side: 205/55 R16.
struct TyreSize {
    double width_mm;
    double aspect_percent; ///< height of the side over the width
    double rim_in;
};

/// Parses "205/55R16", "205/55 R16" or "205/55ZR16"; `std::nullopt` for other text, and for sizes
/// that no car has.
std::optional<TyreSize> parse_tyre_size(std::string_view text);

/// Mounting of the sensor in the car: firm or in a holder.
enum class SensorMount {
    fixed,  ///< screwed, glued or taped to the body
    holder, ///< a holder of phones
};

/// Facts that the owner of a car knows.
struct OwnersData {
    double mass_kg; ///< kerb mass, as in the registration papers
    double wheelbase_m;
    BodyType body;
    std::optional<double> front_share{}; ///< of the mass, on the front axle
    std::optional<TyreSize> tyres{};
    std::optional<double> sensor_behind_front_axle_m{};
    double sensor_left_m = 0; ///< of the middle
    SensorMount mount = SensorMount::holder;
};

/// Estimates all parameters of a car and their uncertainties from what its owner knows. Sources:
/// docs/reference/vehicles.md.
///
/// \param known  within the ranges of its body.
Vehicle vehicle_of(const OwnersData& known, std::string name);

/// ImuMount::lowpass_hz of a sensor that is stated to have none.
inline constexpr double no_lowpass_hz = std::numeric_limits<double>::infinity();

/// Returns the vehicle with the low-pass that sensors have at this rate of readings, unless one is
/// stated: half power at 0.4 of the rate, so that nothing aliases (Bosch BMI160, data sheet
/// BST-BMI160-DS000, section 2.4.1: 20.25 Hz at 50 Hz in normal mode).
Vehicle with_usual_lowpass(Vehicle vehicle, double rate_hz);

} // namespace macadam
