#pragma once

#include <span>
#include <vector>

namespace macadam {

/// Correction of a drive's stations: linear between even knots. Wheel speeds and GNSS give stations
/// to a metre or so, whereas a car that passes a joint must be placed to a few centimetres.
struct ShiftKnots {
    static constexpr double spacing_m = 50;

    double first_m;
    std::size_t count; ///< at least 2
};

ShiftKnots knots_along(std::span<const double> station_m);

/// Returns the share of a knot at a station: 1 at the knot, 0 at its neighbours.
double share_of(const ShiftKnots& knots, std::size_t knot, double station_m);

/// Interpolates a correction given at the knots.
std::vector<double> shifts_at(const ShiftKnots& knots,
                              std::span<const double> value_m,
                              std::span<const double> station_m);

/// Estimates the correction at the knots, to a few decimetres: between 0.7 and 5 Hz, the modelled
/// vertical acceleration is correlated with the measured one over 100 m around each knot. The
/// search begins at the best match within 4 m and follows it in both directions. A knot with less
/// than 25 m of the drive around it gets its neighbour's correction.
///
/// \param measured, modelled  n values each, as many as stations; modelled without correction
std::vector<double> correlated_shifts(const ShiftKnots& knots,
                                      std::span<const double> station_m,
                                      std::span<const double> measured,
                                      std::span<const double> modelled,
                                      double step_s);

} // namespace macadam
