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
    smoother, ///< two axles, both tracks, every sensor at once (smoothed_iri.hpp)
};

/// Which accelerations the method is given.
enum class Channels : std::uint8_t {
    automatic, ///< vertical, else lateral; `tracks` says when both
    vertical,
    lateral,
    both,
};

/// Some of an inertial sensor's channels: accelerations, and rates about x, y, z.
struct SensorSet {
    bool vertical = false, lateral = false, roll = false, pitch = false, yaw = false;
};

struct EstimatorConfig {
    Method method = Method::kf;
    Channels channels = Channels::automatic;

    /// What the smoother is to use with `automatic`, where it was sampled; nothing: what serves it
    /// best (smoothed_iri.hpp).
    std::optional<SensorSet> sensors{};

    /// What `automatic` makes of what feels the difference of the tracks. True: both tracks are
    /// estimated; by the filter from a lateral acceleration beside a vertical one, where the
    /// vehicle's IMU height is known and the road is straight; by the smoother from roll rate, too.
    /// False: these are left out, which costs the tracks and gives the better headline.
    bool tracks = true;
    bool filters = true; ///< the paper's 13, 11 and 0.5 Hz filters
    double q_over_r = 1e9;
    double lateral_regression = 1.39; ///< reference = 1.39 * estimate, paper section VI-B
    double cell_m = 0.25;             ///< of the trace
    double lead_in_m = 60; ///< after a start: 0.1 % of the golden car's transient is left
    bool profile = false;  ///< fill IriRun::profile
};

/// Why a value is not what it could be; flags that add up.
namespace validity {
inline constexpr std::uint8_t ok = 0;
inline constexpr std::uint8_t too_slow = 1;
inline constexpr std::uint8_t start_up = 2;
inline constexpr std::uint8_t gap = 4;
inline constexpr std::uint8_t indicative = 8;

/// Of a pass that is indicative because only the lateral acceleration was there. Without a name:
/// whoever counts such passes asks for it.
inline constexpr std::uint8_t lateral_alone = 16;
} // namespace validity

/// "ok", or the names of the flags joined by '|', in the order above.
std::string name_of_validity(std::uint8_t flags);

/// Elevation under one run at even stations, from an arbitrary zero. Long waves are not observed:
/// there it says what the method's prior says (docs/method/smoother.md).
struct EstimatedProfile {
    double start_travel_m = 0;
    double step_m = 0;
    std::vector<float> left_m{}, right_m{}; ///< empty: not observed
    std::vector<float> centre_m{}; ///< the mean of both; empty: not observed or not asked for
};

/// The rectified suspension stroke of the golden car over one stretch, in cells of even length.
/// IRI of any piece is the mean of its cells, so segments can be cut wherever the road has them.
struct IriRun {
    double start_travel_m; ///< of the first cell: where the centre of gravity stood over that road
    double cell_m;
    std::vector<float> left_mm_per_m; ///< empty: not observed
    std::vector<float> right_mm_per_m;
    std::vector<float> centre_mm_per_m; ///< of the mean profile (HRI)
    std::vector<float> speed_mps;
    double lead_in_m;
    bool indicative; ///< from lateral vibration alone

    /// Of the smoother, empty of the filter: what each of some roads that could have been adds to
    /// the headline over each metre from start_travel_m on.
    std::vector<std::vector<float>> scatter_mm_per_m;
    double common_sd = 0; ///< relative, alike along the whole run: the car is not known exactly
    double random_sd = 0; ///< relative, of one metre, independent of the next: what models leave

    EstimatedProfile profile{}; ///< filled if EstimatorConfig::profile asks for it
};

/// In the order of travel, not overlapping; between two runs nothing is known.
struct IriTrace {
    std::vector<IriRun> runs;
    std::vector<TravelSpan> slow; ///< in order, too: there is no run as the car was too slow
};

/// Method and vehicle behind one function: what a stretch says of the road under it.
IriRun estimate_iri(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config);

/// What the estimate says of one piece of road. Nothing: not observed there.
struct IriMean {
    std::optional<double> left_mm_per_m;
    std::optional<double> right_mm_per_m;
    std::optional<double> mri_mm_per_m;
    std::optional<double> hri_mm_per_m;
    double sd_mm_per_m = 0; ///< of mri where there is one, else of hri
    double speed_mps = 0;
    double covered_m = 0; ///< of the piece, by cells past their lead-in
    std::uint8_t validity = validity::ok;
};

} // namespace macadam
