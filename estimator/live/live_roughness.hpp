#pragma once

#include "estimator/motion/stretch.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/car_tuning.hpp"

#include <cstddef>
#include <optional>

namespace macadam {

struct Mounting; // estimator/motion/mounting.hpp

/// How much of the road behind is smoothed again to say something of a few metres.
struct LiveWindow {
    double length_m = 400;
    double min_s = 8;
    double longest_s = 25; ///< of slow driving, where 400 m are many samples
};

/// Roughness by a window that follows the car: each time the method is run over the last
/// `LiveWindow` up to now, and what the rear axle has left for long enough is kept of it.
class LiveRoughness {
public:
    LiveRoughness(Vehicle vehicle,
                  StretchConfig stretch,
                  EstimatorConfig estimator,
                  LiveWindow window = {});

    /// \param recent    accelerations and rates of turn of the last minute or more.
    /// \param odometer  over the same time.
    /// \param now_s     the latest time of any sensor.
    /// \param final_s   what the rear axle has left by then is final.
    ///
    /// \throws InputError  if vibration is sampled too slowly.
    void go_on(const TripLog& recent,
               const Odometer& odometer,
               const Mounting& mounting,
               double now_s,
               double final_s);

    /// Lets go of what lies before.
    void forget_before(double travel_m);

    const IriTrace& trace() const { return trace_; }

    const Vehicle& vehicle() const { return vehicle_; }

    /// The road of which all is said that will be, whether anything is known of it or not.
    double known_until_m() const { return known_until_m_; }

    /// Of the rear axle from the centre of gravity: negative, 0 for a car with one axle.
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
    std::optional<TunedCar> car_;
    double tuned_by_s_ = 0;
    double rate_hz_ = 0; ///< the log's own
    IriTrace trace_;     ///< its last run is of the stretch that was driven last
    double last_s_;      ///< of that stretch's samples
    double final_s_;     ///< until then it is kept
    double lead_in_until_m_ = 0;
    double slow_until_m_ = 0;
    double known_until_m_ = 0;
};

} // namespace macadam
