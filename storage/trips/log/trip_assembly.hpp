#pragma once

#include "estimator/common/trip.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <optional>

namespace macadam {

/// Assembles the rows of a log into the streams of a trip.
class TripStreams {
public:
    TripStreams(const TripNeeds& needs, const TripHeader& header);

    void add(const TripRow& row);

    /// Returns the trip, without its header data. Where the times of a sensor do not increase, as
    /// many samples as possible are kept: a single wrong time stamp loses only its own sample.
    TripLog take();

    /// Returns the samples of the rows since the last call, in their original order, and continues.
    /// Times are not checked, because that depends on later rows.
    TripLog take_rows();

private:
    /// Contribution of a row to one stream: a flag of row_content, a RowReason, or 0 for empty
    /// cells.
    using RowContribution = std::uint8_t;

    RowContribution
    add_triaxial(TriaxialSamples& to, const TripRow& row, TripColumn x, RowContribution flag) const;
    RowContribution add_acc(const TripRow& row);
    RowContribution add_gyro(const TripRow& row);
    RowContribution add_speed(const TripRow& row);
    RowContribution add_fix(const TripRow& row);
    double speed_in(const TripRow& row) const;
    std::uint8_t contribution_of(const TripRow& row);

    TripNeeds needs_;
    bool wheels_stand_for_speed_;
    TripLog trip_;
    std::optional<GnssFix> last_fix_;
    double last_fix_utc_s_;
};

} // namespace macadam
