#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/car_tuning.hpp"
#include "estimator/smoother/vibration/car_from_vibration.hpp"
#include "estimator/smoother/vibration/vibration_spectra.hpp"

namespace macadam {

/// Tunes a car on one minute from the middle of a stretch.
///
/// \returns  the car for the whole trip. Friction is estimated; the stated parameters are moved
///           where vertical acceleration and pitch rate were both sampled, since one of them alone
///           is not sufficient. The vehicle itself if the stretch is too short.
/// \throws InputError  after a stop request.
TunedCar car_in(const Stretch& stretch,
                const VibratingCar& car,
                const EstimatorConfig& config,
                const std::stop_token& stop = {});

/// Car as the vibration of a trip tells it, and the configuration with which it is read: the tracks
/// are not told apart under axles that were found.
struct CarOfTrip {
    TunedCar car;
    EstimatorConfig config;
};

/// Finds what is not stated of the car and of the sensor's mount from the spectra of a trip
/// (car_from_vibration()), then tunes the car on one of its stretches, by car_in().
///
/// \param spectra  empty where vertical acceleration is not used: the vehicle is tuned as it is
/// 	hrows InputError  after a stop request.
CarOfTrip car_of_trip(const VibrationSpectra& spectra,
                      const Stretch& stretch,
                      const Vehicle& vehicle,
                      const EstimatorConfig& config,
                      const std::stop_token& stop = {});

/// Returns whether the estimate uses vertical acceleration, which the spectra need.
bool uses_vertical(const EstimatorConfig& config);

/// Division of a stretch into pieces for smoothing.
struct PieceConfig {
    double core_m = 1500;            ///< length of a piece without margins, ...
    std::size_t core_samples = 9000; ///< ... or its samples, if the car is slow: some 25 MB
    double margin_m = 225;           ///< on both sides, for start-up and windows
};

/// Estimates both tracks of the road under one stretch by the joint smoother, in overlapping pieces
/// of a kilometre or two, so that memory does not grow with the stretch. Reports progress in cells;
/// after a stop request the rest is missing.
IriRun smoothed_iri(const Stretch& stretch,
                    const TunedCar& car,
                    const EstimatorConfig& config,
                    const PieceConfig& pieces = {},
                    const Progress& progress = {});

} // namespace macadam
