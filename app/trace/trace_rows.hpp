#pragma once

#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/single_trip.hpp"

#include <functional>
#include <optional>
#include <string>

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

/// Returns the column names, with a newline.
std::string trace_csv_header();

/// Formats a row as a line of CSV, or as a JSON object of the same names; lines include the
/// newline.
std::string csv_line_of(const TraceRow& row);
std::string json_line_of(const TraceRow& row);
std::string json_object_of(const TraceRow& row);

} // namespace macadam
