#pragma once

#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/single_trip.hpp"

#include <functional>
#include <optional>
#include <string>

namespace macadam {

/// One row of `trace`: what a trip says of a piece of its own travel. Nothing: not known.
struct TraceRow {
    double from_m;
    double to_m;
    double t_s; ///< at the middle
    std::optional<GeoPoint> at;
    double speed_mps;
    IriMean mean;
};

/// Hands out the rows of a whole trip, one after the other, on multiples of length_m. Rows that lie
/// within a gap of over Odometer::longest_unseen_m are left out.
void each_trace_row(const TripTrace& trace,
                    double length_m,
                    const TripPositions& place,
                    const Vehicle& vehicle,
                    const std::function<void(const TraceRow&)>& take);

/// The names of the columns, with a newline.
std::string trace_csv_header();

/// One line of CSV, or one JSON object of the same names; the lines with their newline.
std::string csv_line_of(const TraceRow& row);
std::string json_line_of(const TraceRow& row);
std::string json_object_of(const TraceRow& row);

} // namespace macadam
