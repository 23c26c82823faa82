#pragma once

#include "estimator/live/live_mounting.hpp"
#include "estimator/live/live_odometer.hpp"
#include "estimator/live/live_roughness.hpp"
#include "estimator/live/sample_buffer.hpp"

#include <optional>
#include <vector>

namespace macadam {

struct LiveConfig {
    OdometerConfig odometer;
    StretchConfig stretch;
    EstimatorConfig estimator;
    LiveWindow window;
    double length_m = 20; ///< length of a row

    /// Maximum delay between the rear axle leaving a row and its output, and minimum duration of
    /// the data beyond the row on which its estimate rests.
    double max_later_s = 1.8;
    double min_later_s = 1.1;
};

/// Estimate for one interval of the travel. Unknown values are `std::nullopt`.
struct LiveRow {
    double from_m;
    double to_m;
    double t_s; ///< time at the middle
    std::optional<GeoPoint> at;
    double speed_mps;
    IriMean mean;
    double left_s; ///< time at which the rear axle left it
};

/// IRI along a trip while it is driven: fixed-lag smoothing, u[k | k + N], with N given by
/// max_later_s.
///
/// Each component works on the data received so far: the odometer (live_odometer.hpp), the mounting
/// (live_mounting.hpp) and the roughness (live_roughness.hpp). Memory is bounded by the sampling
/// rate and by length_m, not by the trip.
class LiveTrace {
public:
    LiveTrace(const TripMeta& meta, Vehicle vehicle, const LiveConfig& config);

    /// Adds samples in order of arrival and returns the rows that they complete.
    ///
    /// \throws InputError  if vibration is sampled too slowly.
    std::vector<LiveRow> add(const TripLog& samples);

    /// Ends the trip and returns the remaining rows, up to the end of the travel.
    std::vector<LiveRow> finish();

    double travelled_m() const; ///< distance so far
    double now_s() const { return recent_.now_s(); }

    // State of the trip so far, for warnings.
    const TripLog& recent() const { return recent_.trip(); }
    const LiveOdometer& ruler() const { return ruler_; }
    const Mounting& mounting() const { return mounting_.mounting(); }

    /// Estimated latency of the receiver, if the log does not state it and both speeds determine
    /// it.
    std::optional<double> found_latency_s() const { return found_latency_s_; }

    /// Resonance of the sensor's holder, once found.
    Resonance mount() const { return roughness_.mount(); }
    std::size_t dropped() const { return recent_.dropped(); } ///< number of samples out of order

private:
    void look_back();
    void look(bool over);
    void note_middle();
    std::optional<double> next_end_s() const;
    std::vector<LiveRow> rows_until(double travel_m);
    LiveRow row_from(double from_m) const;

    /// State at the middle of the next row, kept once it is settled: it may lie minutes back when
    /// the row ends.
    struct Middle {
        double t_s;
        double speed_mps;
        std::optional<GeoPoint> at;
    };
    Middle middle_at(double travel_m) const;

    LiveConfig config_;
    SampleBuffer recent_;
    LiveOdometer ruler_;
    LiveMounting mounting_;
    LiveRoughness roughness_;
    std::optional<double> found_latency_s_;
    double looked_s_;
    double looked_back_s_;
    std::size_t reported_ = 0; ///< number of rows returned
    std::optional<Middle> middle_;
    bool scale_is_free_;
};

} // namespace macadam
