#pragma once

#include "estimator/live/live_mounting.hpp"
#include "estimator/live/live_odometer.hpp"
#include "estimator/live/live_roughness.hpp"
#include "estimator/live/sample_buffer.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace macadam {

struct LiveConfig {
    OdometerConfig odometer;
    StretchConfig stretch;
    EstimatorConfig estimator;
    LiveWindow window;
    double length_m = 20; ///< of a row

    /// The rear axle leaves a row; so much later, at most, the row is told, and it is told of data
    /// that go at least so far on.
    double max_later_s = 1.8;
    double min_later_s = 1.1;
};

/// What is said of one piece of the travel. Nothing: not known.
struct LiveRow {
    double from_m;
    double to_m;
    double t_s; ///< at the middle
    std::optional<GeoPoint> at;
    double speed_mps;
    IriMean mean;
    double left_s; ///< when the rear axle left it
};

/// IRI along a trip while it is driven: fixed-lag smoothing, u[k | k + N], with N of max_later_s.
///
/// Every part looks at what has come so far: the odometer (live_ruler.hpp), the mounting
/// (live_mounting.hpp) and the roughness (live_roughness.hpp). Memory is bounded by the sampling
/// rate and by length_m, not by the trip.
class LiveTrace {
public:
    LiveTrace(const TripMeta& meta, Vehicle vehicle, const LiveConfig& config);

    /// Takes samples in the order in which they come, and tells the rows that they complete.
    ///
    /// \throws InputError  if vibration is sampled too slowly.
    std::vector<LiveRow> add(const TripLog& samples);

    /// The trip ends here: the rest of the rows, as far as the car came.
    std::vector<LiveRow> finish();

    double travelled_m() const; ///< so far
    double now_s() const { return recent_.now_s(); }

    // What is known of the trip so far, for those who warn.
    const TripLog& recent() const { return recent_.trip(); }
    const LiveOdometer& ruler() const { return ruler_; }
    const Mounting& mounting() const { return mounting_.mounting(); }

    /// The receiver's latency, where the log does not state it and its two speeds have told.
    std::optional<double> found_latency_s() const { return found_latency_s_; }
    std::size_t dropped() const { return recent_.dropped(); } ///< samples out of their order

private:
    void look_back();
    void look(bool over);
    void note_middle();
    std::optional<double> next_end_s() const;
    std::vector<LiveRow> rows_until(double travel_m);
    LiveRow row_from(double from_m) const;

    /// The middle of the next row, once it is settled: it may lie minutes back when the row ends.
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
    std::size_t told_ = 0; ///< rows
    std::optional<Middle> middle_;
    bool scale_is_free_;
};

} // namespace macadam
