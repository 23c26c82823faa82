#pragma once

#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/single_trip.hpp"
#include "storage/text/columns.hpp"

#include <functional>
#include <optional>

namespace macadam {

/// Row of `trace`: roughness over an interval of the trip's travel. `std::nullopt`: not known.
struct TraceRow {
    double from_m;
    double to_m;
    double t_s; ///< at the middle
    std::optional<GeoPoint> at;
    double speed_mps;
    IriMean mean;
};

/// Emits the rows of a whole trip in order, at multiples of length_m. Rows within a gap longer than
/// Odometer::longest_unseen_m are omitted.
void each_trace_row(const TripTrace& trace,
                    double length_m,
                    const TripPositions& place,
                    const Vehicle& vehicle,
                    const std::function<void(const TraceRow&)>& take);

/// Columns of CSV, and members of JSON.
const Columns<TraceRow>& trace_columns();

} // namespace macadam
