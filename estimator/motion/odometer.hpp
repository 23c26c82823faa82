#pragma once

#include "estimator/common/trip.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

struct OdometerConfig {
    double max_gap_s = 2.5;     ///< longest gap in the speed that is bridged
    double max_speed_mps = 90;  ///< upper bound of a plausible car speed
    double max_accel_mps2 = 12; ///< largest plausible change between consecutive speed readings
};

/// Distance travelled over the time of one trip: the common reference of roughness and position.
///
/// It integrates wheel speed if available, scaled to agree with GNSS over the whole trip; otherwise
/// GNSS speed, or without that the distance between fixes. Time stamps are corrected by the trip's
/// latencies. Gaps in the speeds are bridged by the fixes on both sides.
class Odometer {
public:
    /// Knots of a piecewise linear speed. Sizes agree, t_s increases, travel_m never decreases.
    struct Knots {
        std::vector<double> t_s;
        std::vector<double> travel_m;
        std::vector<float> speed_mps; ///< NaN in gaps: not known between this knot and the next
        std::vector<std::uint8_t> reversing; ///< 1: the wheels turned backward
    };

    /// Travel while the recording was paused and its clock stopped: the position jumped.
    struct Pause {
        double from_m;
        double to_m;
    };

    explicit Odometer(Knots knots, double scale = 1, std::vector<Pause> pauses = {});

    /// Never decreases; constant before the first and after the last knot.
    double travel_m(double t_s) const;

    /// NaN where not known.
    double speed_mps(double t_s) const;

    /// Returns true if the wheels turned backward, as far as the log shows.
    bool reversing(double t_s) const;

    /// Returns the time at which this travel was reached; the first, if the car stood there.
    double t_s(double travel_m) const;

    double whole_m() const;
    double start_s() const;
    double end_s() const;

    /// Returns the factor applied to wheel speed; 1 if it was not compared.
    double scale() const { return scale_; }

    /// Returns the end of a gap longer than `longest_unseen_m` without recorded data that contains
    /// all of this travel, or from_m if there is none. Loops that step along the travel continue
    /// there, so that their cost depends on the recorded data and not on the distance between
    /// positions.
    double past_gap_m(double from_m, double to_m) const;
    static constexpr double longest_unseen_m = 1000;

    /// In order, not overlapping; the travel over them is the straight distance between positions.
    const std::vector<Pause>& pauses() const { return pauses_; }

    const Knots& knots() const { return knots_; }

private:
    std::size_t piece_at(double t_s) const;

    Knots knots_;
    double scale_;
    std::vector<Pause> pauses_;
};

} // namespace macadam
