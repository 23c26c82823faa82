#include "app/trace/trace_events.hpp"

#include "app/cli/row_writer.hpp"

#include "estimator/common/error.hpp"
#include "estimator/events/event_detection.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/exports/event_export.hpp"
#include "storage/text/columns.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

namespace macadam {
namespace {

/// Event with its time and position.
struct EventRow {
    RoadEvent event;
    double t_s;
    std::optional<GeoPoint> at;
    double speed_mps;
};

std::vector<RoadEvent> events_of(const IriTrace& roughness) {
    const auto has_elevations = [](const IriRun& run) { return !run.profile.centre_m.empty(); };
    if (std::ranges::none_of(roughness.runs, has_elevations)) {
        throw InputError{roughness.runs.empty()
                             ? "has no part driven steadily, expected one for --events"
                             : "was estimated from lateral acceleration only, which does not give "
                               "elevations, expected vertical acceleration for --events"};
    }
    std::vector<RoadEvent> events;
    for (const auto& run : roughness.runs) {
        std::ranges::move(detect_events(run.profile), std::back_inserter(events));
    }
    return events;
}

EventRow row_of(const RoadEvent& event,
                const Odometer& odometer,
                const TripPositions& place,
                double ahead_m) {
    const double t_s = odometer.t_s(event.travel_m);
    // The antenna was over the event earlier than the centre of gravity, or later.
    return {.event = event,
            .t_s = t_s,
            .at = place(odometer.t_s(event.travel_m - ahead_m)),
            .speed_mps = odometer.speed_mps(t_s)};
}

std::optional<double> latitude_of(const EventRow& row) {
    return row.at ? std::optional{row.at->lat_deg} : std::nullopt;
}

std::optional<double> longitude_of(const EventRow& row) {
    return row.at ? std::optional{row.at->lon_deg} : std::nullopt;
}

using R = const EventRow&;

const Columns<EventRow> columns{
    {"kind", as::text, [](R r) { return Cell{name_of(r.event.kind)}; }},
    {"severity", as::text, [](R r) { return Cell{name_of(severity_of(r.event.size_mm))}; }},
    {"track", as::text, [](R r) { return Cell{name_of(r.event.track)}; }},
    {"size_mm", as::real(0, "mm"), [](R r) { return Cell{r.event.size_mm}; }},
    {"size_sd_mm", as::real(0, "mm"), [](R r) { return Cell{r.event.sd_mm}; }},
    {"length_m", as::metres(2), [](R r) { return Cell{r.event.length_m}; }},
    {"travel_m", as::metres(2), [](R r) { return Cell{r.event.travel_m}; }},
    {"t_s", as::seconds(3), [](R r) { return Cell{r.t_s}; }},
    {"lat_deg", as::degrees, [](R r) { return Cell{latitude_of(r)}; }},
    {"lon_deg", as::degrees, [](R r) { return Cell{longitude_of(r)}; }},
    {"speed_mps", as::real(3, "m/s"), [](R r) { return Cell{r.speed_mps}; }},
    {"score", as::real(1), [](R r) { return Cell{r.event.score}; }},
};

/// Formats an event that has a position as a Feature, whose geometry says it.
std::string feature_of(const EventRow& row) {
    auto properties = columns;
    std::erase_if(properties, [](const auto& column) {
        return column.name == "lat_deg" || column.name == "lon_deg";
    });
    return geojson_feature(*row.at, json_object(properties, row));
}

} // namespace

std::size_t write_events(const std::filesystem::path& file,
                         const TripTrace& trace,
                         const TripPositions& place,
                         double ahead_m) {
    std::vector<EventRow> rows;
    for (const auto& event : events_of(trace.roughness)) {
        rows.push_back(row_of(event, trace.odometer, place, ahead_m));
    }
    const auto format = file.extension().string().substr(1); // csv, json or geojson
    auto written = rows;
    if (format == "geojson") {
        std::erase_if(written, [](const EventRow& row) { return !row.at; });
    }
    AtomicFile out{file};
    out.write(rows_text(columns, written, format, feature_of));
    out.commit();
    return rows.size();
}

} // namespace macadam
