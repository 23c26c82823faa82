#pragma once

#include "estimator/motion/stretch.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

enum class Method : std::uint8_t {
    kf,       ///< the published Kalman filter on a quarter car or lateral half-car
    smoother, ///< two axles, both tracks, all sensors jointly (smoothed_iri.hpp)
};

/// Accelerations that the method uses.
enum class Channels : std::uint8_t {
    automatic, ///< vertical, else lateral; `tracks` decides on both
    vertical,
    lateral,
    both,
};

/// Set of an inertial sensor's channels: accelerations, and rates about x, y, z.
struct SensorSet {
    bool vertical = false, lateral = false, roll = false, pitch = false, yaw = false;
};

struct EstimatorConfig {
    Method method = Method::kf;
    Channels channels = Channels::automatic;

    /// Channels that the smoother uses with `automatic`, where sampled; `std::nullopt`: the best
    /// set for it (smoothed_iri.hpp).
    std::optional<SensorSet> sensors{};

    /// Use of channels that observe the difference of the tracks, with `automatic`. True: both
    /// tracks are estimated; the filter uses a lateral acceleration beside a vertical one, where
    /// the vehicle's IMU height is known and the road is straight; the smoother also uses roll
    /// rate. False: these channels are left out, which gives up the tracks and improves the
    /// headline.
    bool tracks = true;
    bool filters = true; ///< the paper's 13, 11 and 0.5 Hz filters
    double q_over_r = 1e9;
    double lateral_regression = 1.39; ///< reference = 1.39 * estimate, paper section VI-B
    double cell_m = 0.25;             ///< cell length of the trace
    double lead_in_m = 60; ///< after a start: 0.1 % of the golden car's transient remains
    bool profile = false;  ///< fill IriRun::profile
};

/// Limitations of a value, as flags that are combined.
namespace validity {
inline constexpr std::uint8_t ok = 0;
inline constexpr std::uint8_t too_slow = 1;
inline constexpr std::uint8_t start_up = 2;
inline constexpr std::uint8_t gap = 4;
inline constexpr std::uint8_t indicative = 8;

/// Flag of a pass that is indicative because only the lateral acceleration was available. It has no
/// name: code that counts such passes tests for it.
inline constexpr std::uint8_t lateral_alone = 16;
} // namespace validity

/// Returns "ok", or the names of the flags joined by '|', in the order above.
std::string name_of_validity(std::uint8_t flags);

/// Elevation under one run at even stations, from an arbitrary zero. Long waves are not observed:
/// they follow the method's prior (docs/method/smoother.md).
struct EstimatedProfile {
    double start_travel_m = 0;
    double step_m = 0;
    std::vector<float> left_m{}, right_m{}; ///< empty: not observed
    std::vector<float> centre_m{};          ///< mean of both; empty: not observed or not requested

    /// Smoother only: one draw of the error of each from its posterior.
    std::vector<float> left_error_m{}, right_error_m{}, centre_error_m{};
};

/// Rectified suspension stroke of the golden car over one stretch, in cells of equal length. The
/// IRI of any interval is the mean of its cells, so that segments can be cut at any position.
struct IriRun {
    double start_travel_m; ///< of the first cell: travel of the centre of gravity over that road
    double cell_m;
    std::vector<float> left_mm_per_m; ///< empty: not observed
    std::vector<float> right_mm_per_m;
    std::vector<float> centre_mm_per_m; ///< of the mean profile (HRI)
    std::vector<float> speed_mps;
    double lead_in_m;
    bool indicative; ///< from lateral acceleration alone

    /// Smoother only, empty for the filter: contribution of each sampled road to the headline over
    /// each metre from start_travel_m.
    std::vector<std::vector<float>> scatter_mm_per_m;
    double common_sd = 0; ///< relative, common to the whole run: uncertainty of the car
    double random_sd = 0; ///< relative, of one metre, independent of the next: model error

    EstimatedProfile profile{}; ///< filled if EstimatorConfig::profile is set
};

/// Runs in order of travel, not overlapping; between two runs the roughness is unknown.
struct IriTrace {
    std::vector<IriRun> runs;
    std::vector<TravelSpan> slow; ///< in order; no run because the car was too slow
};

/// Estimates the roughness of the road under a stretch by the configured method.
IriRun estimate_iri(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config);

/// Mean estimate of one interval of road. `std::nullopt`: not observed there.
struct IriMean {
    std::optional<double> left_mm_per_m;
    std::optional<double> right_mm_per_m;
    std::optional<double> mri_mm_per_m;
    std::optional<double> hri_mm_per_m;
    double sd_mm_per_m = 0; ///< of mri if present, else of hri
    double speed_mps = 0;
    double covered_m = 0; ///< length of the interval covered by cells past their lead-in
    std::uint8_t validity = validity::ok;
};

} // namespace macadam
