#pragma once

#include "app/pipeline.hpp"
#include "app/trip_place.hpp"

#include <optional>
#include <span>
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

TraceRow trace_row(double from_m,
                   double length_m,
                   const TripTrace& trace,
                   const TripPlace& place,
                   const Vehicle& vehicle);

/// The names of the columns, with a newline.
std::string trace_csv_header();

/// One line of CSV, or one JSON object of the same names, with its newline.
std::string csv_line_of(const TraceRow& row);
std::string json_line_of(const TraceRow& row);

/// All of them as one document: CSV with its header, or a JSON array.
std::string trace_csv(std::span<const TraceRow> rows);
std::string trace_json(std::span<const TraceRow> rows);

} // namespace macadam
