#pragma once

#include "estimator/motion/stretch.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include <optional>

namespace macadam {

struct Mounting; // estimator/motion/mounting.hpp

/// Length of the window behind the car that is smoothed again to estimate a few metres.
struct LiveWindow {
    double length_m = 400;
    double min_s = 8;
    double longest_s = 25; ///< limit at low speed, where 400 m hold many samples
};

/// Roughness estimation in a window that follows the car: the method is run over the last
/// `LiveWindow` up to now, and results that the rear axle left long enough ago are kept.
class LiveRoughness {
public:
    LiveRoughness(Vehicle vehicle,
                  StretchConfig stretch,
                  EstimatorConfig estimator,
                  LiveWindow window = {});

    /// \param recent    accelerations and rates of turn of the last minute or more.
    /// \param odometer  over the same time.
    /// \param now_s     the latest time of any sensor.
    /// \param final_s   time up to which positions that the rear axle has left become final.
    ///
    /// \throws InputError  if vibration is sampled too slowly.
    void go_on(const TripLog& recent,
               const Odometer& odometer,
               const Mounting& mounting,
               double now_s,
               double final_s);

    /// Discards results before travel_m.
    void forget_before(double travel_m);

    const IriTrace& trace() const { return trace_; }

    const Vehicle& vehicle() const { return vehicle_; }

    /// Resonance of the sensor's holder, as far as it is known; hz is 0 without one.
    Resonance mount() const { return car_ ? car_->car.mount : Resonance{}; }

    /// End of the final part of the trace, whether or not it has values.
    double known_until_m() const { return known_until_m_; }

    /// Position of the rear axle relative to the centre of gravity: negative, or 0 for a car with
    /// one axle.
    double rear_m() const;

private:
    void tune(const TripLog& recent,
              const StretchSpan& span,
              const Odometer& odometer,
              const Mounting& mounting);
    void extend(const TripLog& recent,
                const StretchSpan& span,
                const Odometer& odometer,
                const Mounting& mounting,
                double final_s);
    void keep(const IriRun& found, double to_m);
    void add_slow(const Odometer& odometer, double until_s);

    Vehicle vehicle_;
    StretchConfig stretch_;
    EstimatorConfig estimator_;
    LiveWindow window_;
    std::optional<CarOfTrip> car_;
    double tuned_by_s_ = 0;
    double rate_hz_ = 0; ///< rate of the log
    IriTrace trace_;     ///< the last run belongs to the most recent stretch
    double last_s_;      ///< time of that stretch's last sample
    double final_s_;     ///< end of the time that is kept of it
    double lead_in_until_m_ = 0;
    double slow_until_m_ = 0;
    double known_until_m_ = 0;
};

} // namespace macadam
