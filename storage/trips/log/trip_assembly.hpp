#pragma once

#include "estimator/common/trip.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <optional>

namespace macadam {

/// Puts the rows of a log one after the other into the streams of a trip.
class TripStreams {
public:
    TripStreams(const TripNeeds& needs, const TripHeader& header);

    void add(const TripRow& row);

    std::size_t rows() const { return trip_.rows.size(); }

    /// The trip, without what its head says. Where the times of a sensor do not rise, as many of
    /// its samples are kept as can be: a single wild stamp costs itself only.
    TripLog take();

    /// The samples of the rows since the last call, in the order in which they came, and goes on.
    /// Nothing is put in order: what is still to come decides that.
    TripLog take_rows();

private:
    /// What a row gave to one stream: a flag of row_content, a RowReason, or 0 for an empty place.
    using RowContribution = std::uint8_t;

    RowContribution
    add_triaxial(TriaxialSamples& to, const TripRow& row, TripColumn x, RowContribution flag) const;
    RowContribution add_acc(const TripRow& row);
    RowContribution add_gyro(const TripRow& row);
    RowContribution add_speed(const TripRow& row);
    RowContribution add_fix(const TripRow& row);
    double speed_in(const TripRow& row) const;
    std::uint8_t gifts_of(const TripRow& row);

    TripNeeds needs_;
    bool wheels_stand_for_speed_;
    TripLog trip_;
    std::optional<GnssFix> last_fix_;
    double last_fix_utc_s_;
};

} // namespace macadam
