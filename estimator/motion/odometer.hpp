#pragma once

#include "estimator/common/trip.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

struct OdometerConfig {
    double max_gap_s = 2.5;     ///< longest silence of speed that is bridged
    double max_speed_mps = 90;  ///< more is not a car
    double max_accel_mps2 = 12; ///< of the speed from one reading to the next; more is a fault
};

/// Travel distance over the time of one trip: the one ruler that roughness and place share.
///
/// Wheel speed carries it where there is some, scaled to agree with GNSS over the whole trip;
/// otherwise GNSS speed, or failing that the way between fixes. Stamps are corrected by the trip's
/// latencies. Across a gap in the speeds the travel goes on by what the fixes on both sides say.
class Odometer {
public:
    /// Knots of a piecewise linear speed. Sizes agree, t_s rises, travel_m never falls.
    struct Knots {
        std::vector<double> t_s;
        std::vector<double> travel_m;
        std::vector<float> speed_mps; ///< NaN in gaps: not known between this knot and the next
        std::vector<std::uint8_t> reversing; ///< 1: the wheels turned backward
    };

    /// Travel while the recording was paused and its clock stood: the places jumped.
    struct Pause {
        double from_m;
        double to_m;
    };

    explicit Odometer(Knots knots, double scale = 1, std::vector<Pause> pauses = {});

    /// Never falls; held still before the first and after the last knot.
    double travel_m(double t_s) const;

    /// NaN where not known.
    double speed_mps(double t_s) const;

    /// Whether the wheels turned backward, as far as the log tells.
    bool reversing(double t_s) const;

    /// Time at which the trip had gone so far: the first, if it stood there.
    double t_s(double travel_m) const;

    double whole_m() const;
    double start_s() const;
    double end_s() const;

    /// By how much wheel speed was multiplied; 1 where it was not compared.
    double scale() const { return scale_; }

    /// The end of the gap of over `longest_unseen_m` within which nothing was recorded and that
    /// holds all of this travel; from_m if there is none. What goes step by step along the travel
    /// goes on there, so that its work goes with what was recorded and not with how far places
    /// lie apart.
    double past_gap_m(double from_m, double to_m) const;
    static constexpr double longest_unseen_m = 1000;

    /// In order, not overlapping; the travel over them is straight from place to place.
    const std::vector<Pause>& pauses() const { return pauses_; }

    const Knots& knots() const { return knots_; }

private:
    std::size_t piece_at(double t_s) const;

    Knots knots_;
    double scale_;
    std::vector<Pause> pauses_;
};

/// Nothing used yet: every sample `unused_channel`.
RowAudit unused(const TripLog& trip);

} // namespace macadam
