#include "app/trace/trace_events.hpp"

#include "estimator/common/error.hpp"
#include "estimator/events/event_detection.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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

std::string csv_of(const std::vector<EventRow>& rows) {
    std::string csv = "kind,severity,track,size_mm,size_sd_mm,length_m,travel_m,t_s,lat_deg,"
                      "lon_deg,speed_mps,score\n";
    for (const auto& [event, t_s, at, speed_mps] : rows) {
        csv += fmt::format("{},{},{},{:.0f},{:.0f},{:.2f},{:.2f},{:.3f},{},{},{:.1f}\n",
                           name_of(event.kind),
                           name_of(severity_of(event.size_mm)),
                           name_of(event.track),
                           event.size_mm,
                           event.sd_mm,
                           event.length_m,
                           event.travel_m,
                           t_s,
                           at ? fmt::format("{:.7f},{:.7f}", at->lat_deg, at->lon_deg) : ",",
                           std::isfinite(speed_mps) ? fmt::format("{:.3f}", speed_mps) : "",
                           event.score);
    }
    return csv;
}

JsonObject properties_of(const EventRow& row) {
    const auto& event = row.event;
    JsonObject object;
    object.add("kind", std::string{name_of(event.kind)})
        .add("severity", std::string{name_of(severity_of(event.size_mm))})
        .add("track", std::string{name_of(event.track)})
        .add("size_mm", JsonNumber{event.size_mm, 0})
        .add("size_sd_mm", JsonNumber{event.sd_mm, 0})
        .add("length_m", JsonNumber{event.length_m, 2})
        .add("travel_m", JsonNumber{event.travel_m, 2})
        .add("t_s", JsonNumber{row.t_s, 3});
    return object;
}

void add_speed_and_score(JsonObject& object, const EventRow& row) {
    object.add("speed_mps", json_number(row.speed_mps, 3))
        .add("score", JsonNumber{row.event.score, 1});
}

std::string json_of(const std::vector<EventRow>& rows) {
    std::vector<std::string> objects;
    for (const auto& row : rows) {
        auto object = properties_of(row);
        object
            .add("lat_deg", json_number(row.at ? std::optional{row.at->lat_deg} : std::nullopt, 7))
            .add("lon_deg", json_number(row.at ? std::optional{row.at->lon_deg} : std::nullopt, 7));
        add_speed_and_score(object, row);
        objects.push_back(object.text());
    }
    return json_array(objects) + "\n";
}

std::string geojson_of(const std::vector<EventRow>& rows) {
    std::vector<std::string> features;
    for (const auto& row : rows) {
        if (!row.at) {
            continue;
        }
        auto properties = properties_of(row);
        add_speed_and_score(properties, row);
        JsonObject point;
        point.add("type", std::string{"Point"})
            .add("coordinates",
                 JsonRaw{fmt::format("[{:.7f},{:.7f}]", row.at->lon_deg, row.at->lat_deg)});
        JsonObject feature;
        feature.add("type", std::string{"Feature"})
            .add("geometry", JsonRaw{point.text()})
            .add("properties", JsonRaw{properties.text()});
        features.push_back(feature.text());
    }
    JsonObject collection;
    collection.add("type", std::string{"FeatureCollection"})
        .add("features", JsonRaw{json_array(features)});
    return collection.text() + "\n";
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
    AtomicFile out{file};
    out.write(file.extension() == ".csv"    ? csv_of(rows)
              : file.extension() == ".json" ? json_of(rows)
                                            : geojson_of(rows));
    out.commit();
    return rows.size();
}

} // namespace macadam
