#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

#include <array>
#include <vector>

namespace macadam {

/// Shape of the spectrum of a road's changes from station to station, by octaves of wavelength: 0.5
/// to 1 m, ..., 32 to 64 m. Even levels are waviness 2; the spectra of measured roads bend, mostly
/// at 5 to 10 m.
struct SpectrumShape {
    static constexpr std::size_t octaves = 7;
    static constexpr double shortest_m = 0.5;

    std::array<double, octaves> log_level{}; ///< natural logarithm of the power
};

/// A process whose changes are a sum of `weights` times the changes before, plus an increment.
struct Autoregression {
    std::vector<double> weights;   ///< RoadPrior::change_weights, the nearest first
    double increment_variance = 1; ///< in the unit of the spectrum; 1 for levels of 0
};

/// Returns the autoregression that has the spectrum, as far as its order permits.
Autoregression autoregression_of(const SpectrumShape& shape, double cell_m);

/// Updates the shape after a round: the power of the smoothed increments in each octave over the
/// share of it that the data determine, as road_prior_scale.hpp does it for the level. Octaves of
/// which the readings tell little follow their neighbours.
///
/// \param shape  that of `prior`, on any level
/// \returns      levels whose increment_variance is what the shape multiplies that of `prior` by
SpectrumShape adapted(const SpectrumShape& shape,
                      const RoadPrior& prior,
                      const SmoothedRoad& road,
                      double cell_m);

} // namespace macadam
