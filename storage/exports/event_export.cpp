#include "storage/exports/event_export.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/exports/feature_table.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 5> suffixes{
    ".geojson", ".geojsonl", ".csv", ".gpkg", ".kml"};

constexpr double mm_per_m = 1000, um_per_mm = 1000;

using R = const EventRecord&;
using Events = std::vector<EventRecord>;

double size_mm(R r) {
    return r.event.size_um / um_per_mm;
}

double at_m(R r) {
    return static_cast<double>(r.event.at_mm) / mm_per_m;
}

Cell day_of(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? Cell{utc_day(*utc_ms)} : Cell{};
}

Cell unless_empty(const std::string& text) {
    return known_if(!text.empty(), text);
}

std::string road_of(R r) {
    return r.name.empty() ? r.highway : r.name;
}

std::string passes_of(R r) {
    return fmt::format("{} of {}", r.event.passes, r.event.passes_over);
}

// clang-format off
const Columns<EventRecord> fields{
    {"kind", as::required(as::text), [](R r) { return name_of(r.event.kind); },
     {"kind", "{:<8}"}},
    {"severity", as::required(as::text), [](R r) { return name_of(severity_of(size_mm(r))); },
     {"severity", " {:<8}"}},
    {"track", as::required(as::text), [](R r) { return name_of(r.event.track); },
     {"track", " {:<7}"}},
    {"size_mm", as::required(as::real(0, "mm")), size_mm, {"mm", " {:>4}"}},
    {"size_sd_mm", as::required(as::real(0, "mm")), [](R r) { return r.event.sd_um / um_per_mm; },
     {"sd", " {:>3}"}},
    {"length_m", as::required(as::metres(2)), [](R r) { return r.event.length_mm / mm_per_m; }},
    {"lat_deg", as::required(as::degrees), [](R r) { return r.at.lat_deg; }, {"lat", "  {:>10}", 6}},
    {"lon_deg", as::required(as::degrees), [](R r) { return r.at.lon_deg; }, {"lon", " {:>11}", 6}},
    {"place_sd_m", as::required(as::metres(2)), [](R r) { return r.event.place_sd_mm / mm_per_m; }},
    {"name", as::text, [](R r) { return unless_empty(r.name); }},
    {"highway", as::text, [](R r) { return unless_empty(r.highway); }},
    {"", as::text, road_of, {"road", "  {:<24.24}"}},
    {"segment", as::required(as::text), [](R r) { return name_of(r.event.segment); },
     {"segment", " {:<18}"}},
    {"way_id", as::required(as::integer), [](R r) { return r.event.segment.way_id; }},
    {"direction", as::required(as::text),
     [](R r) { return r.event.segment.forward ? "forward" : "backward"; }},
    {"at_m", as::required(as::metres(1)), at_m, {"at m", " {:>8}"}},
    {"passes", as::required(as::integer), [](R r) { return r.event.passes; }},
    {"passes_over", as::required(as::integer), [](R r) { return r.event.passes_over; }},
    {"", as::text, passes_of, {"passes", " {:>9}"}},
    {"vehicles", as::required(as::integer), [](R r) { return r.event.vehicles; }, {"cars", " {:>4}"}},
    {"first_seen", as::day, [](R r) { return day_of(r.event.first_seen_ms); }},
    {"last_seen", as::day, [](R r) { return day_of(r.event.last_seen_ms); }, {"last seen", "  {}"}},
};
// clang-format on

using Attributes = Columns<EventRecord>;

Attributes attributes_in(UnitSystem units) {
    return in_units(attributes_of(fields), units);
}

// ---------------------------------------------------------------------------------- GeoPackage

void write_rows(Database& database, const Events& events, const Attributes& attributes) {
    auto insert = database.prepare(feature_insert("events", attributes));
    for (const auto& record : events) {
        insert.bind(Blob{geometry_of(record.at)});
        int position = 1;
        for (const auto& column : attributes) {
            insert.bind_at(++position, plain_text(column.type, column.value(record)));
        }
        insert.step();
    }
}

/// Dates the layer by its last event, so that equal events give equal bytes.
void date_by_content(Database& database, const Events& events) {
    std::int64_t last_ms = 0;
    for (const auto& record : events) {
        last_ms = std::max(last_ms, record.event.last_seen_ms.value_or(0));
    }
    database.prepare("UPDATE gpkg_contents SET last_change = ?")
        .run(utc_day(last_ms) + "T00:00:00.000Z");
}

void write_geopackage(const StoreReader& store,
                      const Events& events,
                      const std::filesystem::path& file,
                      const Attributes& attributes) {
    AtomicFileSet files{file};
    {
        Database database{files.main_file(), Database::Access::create, file};
        add_geometry_functions(database);
        Transaction all{database, Transaction::Kind::write};
        make_geopackage(database);
        database.run(feature_table("events", "POINT", attributes));
        write_rows(database, events, attributes);
        GeoBox box;
        for (const auto& record : events) {
            box = including(box, record.at);
        }
        list_features(
            database,
            {.table = "events",
             .title = "events",
             .description = "Potholes, bumps, joints, rails. " + store.settings().attribution,
             .box = is_empty(box) ? store.info().box : box,
             .geometry = "POINT"});
        index_features(database, "events");
        date_by_content(database, events);
        all.commit();
    }
    store.expect_in_place();
    remove_leftovers_of(file);
    files.commit();
}

// ----------------------------------------------------------------------------------- text files

/// Formats an event as a Placemark of KML 2.2 (OGC 07-147r2, 9.2).
std::string placemark(const EventRecord& record, const Attributes& attributes) {
    std::string data;
    for (const auto& column : attributes) {
        if (const auto text = plain_text(column.type, column.value(record))) {
            data += fmt::format(
                "<Data name=\"{}\"><value>{}</value></Data>", column.name, xml_text(*text));
        }
    }
    return fmt::format("<Placemark><name>{}</name><ExtendedData>{}</ExtendedData><Point>"
                       "<coordinates>{:.7f},{:.7f}</coordinates></Point></Placemark>\n",
                       name_of(record.event.kind),
                       data,
                       record.at.lon_deg,
                       record.at.lat_deg);
}

std::string
kml_text(const Events& events, const std::string& attribution, const Attributes& attributes) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n"
                       "<Document id=\"macadam\"><name>events</name>\n" +
                       fmt::format("<description>{}</description>\n", xml_text(attribution));
    for (const auto& record : events) {
        text += placemark(record, attributes);
    }
    return text + "</Document>\n</kml>\n";
}

std::string feature_of(const EventRecord& record, const Columns<EventRecord>& columns) {
    return geojson_feature(record.at, json_object(columns, record));
}

std::string geojson_text(const Events& events,
                         const std::string& attribution,
                         const Columns<EventRecord>& columns) {
    auto text = R"({"type":"FeatureCollection","name":"events","attribution":)" +
                json_text(attribution) + ",\"features\":[";
    const char* separator = "\n";
    for (const auto& record : events) {
        text += separator + feature_of(record, columns);
        separator = ",\n";
    }
    return text + "\n]}\n";
}

std::string text_as(std::string_view suffix,
                    const Events& events,
                    const std::string& attribution,
                    const TextExport& how) {
    const auto columns = in_units(fields, how.units);
    if (suffix == ".geojson") {
        return geojson_text(events, attribution, columns);
    }
    if (suffix == ".kml") {
        return kml_text(events, attribution, attributes_in(how.units));
    }
    std::string text = suffix == ".csv" ? csv_header(columns) : std::string{};
    for (const auto& record : events) {
        text += suffix == ".csv" ? csv_line(columns, record) : feature_of(record, columns) + "\n";
    }
    return how.excel && suffix == ".csv" ? ExcelCsv{*how.excel}(text) : text;
}

} // namespace

const Columns<EventRecord>& event_fields() {
    return fields;
}

std::string geojson_feature(const GeoPoint& at, const JsonObject& properties) {
    JsonObject point;
    point.add("type", "Point")
        .add("coordinates", JsonRaw{fmt::format("[{:.7f},{:.7f}]", at.lon_deg, at.lat_deg)});
    JsonObject feature;
    feature.add("type", "Feature")
        .add("geometry", JsonRaw{point.text()})
        .add("properties", JsonRaw{properties.text()});
    return feature.text();
}

std::string geojson_feature(const EventRecord& record) {
    return geojson_feature(record.at, json_object(fields, record));
}

std::span<const std::string_view> event_export_suffixes() {
    return suffixes;
}

std::size_t export_events(const StoreReader& store,
                          const SegmentFilter& filter,
                          const std::filesystem::path& file,
                          const TextExport& text) {
    const auto suffix = file.extension().string();
    if (std::ranges::find(suffixes, suffix) == suffixes.end()) {
        throw InputError{fmt::format("{}: suffix '{}', expected one of {} for events",
                                     file.string(),
                                     suffix,
                                     fmt::join(suffixes, ", "))};
    }
    const auto events = store.events(filter);
    if (suffix == ".gpkg") {
        write_geopackage(store, events, file, attributes_in(text.units));
        return events.size();
    }
    const auto content = text_as(suffix, events, store.settings().attribution, text);
    if (text.put) {
        store.expect_in_place();
        text.put(content);
        return events.size();
    }
    AtomicFile out{file};
    out.write(content);
    store.expect_in_place();
    out.commit();
    return events.size();
}

} // namespace macadam
