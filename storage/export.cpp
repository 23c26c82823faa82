#include "storage/export.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/late_library.hpp"
#include "storage/atomic_file.hpp"
#include "storage/geopackage.hpp"
#include "storage/json.hpp"
#include "storage/late/flatgeobuf.hpp"
#include "storage/segment_row.hpp"
#include "storage/sqlite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 5> suffixes{
    ".geojson", ".geojsonl", ".csv", ".gpkg", ".fgb"};

const ClassTable& classes_of(const RoadStore& store) {
    return *class_table(store.settings().class_table);
}

/// Visits, counts and tells how far it is. A stop wanted ends it with an error, so that no half
/// file takes its place.
std::size_t each(const RoadStore& store,
                 const SegmentFilter& filter,
                 const Progress& progress,
                 const std::function<void(const SegmentRecord&)>& write) {
    constexpr std::size_t report_every = 1000;
    std::size_t written = 0;
    store.visit(filter, [&](const SegmentRecord& record) {
        write(record);
        if (++written % report_every == 0) {
            progress(written, 0);
        }
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the file was whole"};
        }
    });
    return written;
}

// ---------------------------------------------------------------------------------------- text

std::size_t write_geojson(const RoadStore& store,
                          const SegmentFilter& filter,
                          AtomicFile& file,
                          const Progress& progress) {
    file.write(R"({"type":"FeatureCollection","name":"roughness","attribution":)" +
               json_text(store.settings().attribution) + ",\"features\":[");
    const char* separator = "\n";
    const auto written = each(store, filter, progress, [&](const SegmentRecord& record) {
        file.write(separator + geojson_feature(record, classes_of(store)));
        separator = ",\n";
    });
    file.write("\n]}\n");
    return written;
}

std::size_t write_geojson_lines(const RoadStore& store,
                                const SegmentFilter& filter,
                                AtomicFile& file,
                                const Progress& progress) {
    return each(store, filter, progress, [&](const SegmentRecord& record) {
        file.write(geojson_feature(record, classes_of(store)) + "\n");
    });
}

std::size_t write_csv(const RoadStore& store,
                      const SegmentFilter& filter,
                      AtomicFile& file,
                      const Progress& progress) {
    file.write(csv_header() + "\n");
    return each(store, filter, progress, [&](const SegmentRecord& record) {
        file.write(csv_row(record, classes_of(store)) + "\n");
    });
}

// ---------------------------------------------------------------------------------- GeoPackage

constexpr const char* roughness_table = R"(
CREATE TABLE roughness (
    fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,
    geom LINESTRING,
    segment TEXT NOT NULL,
    way_id INTEGER NOT NULL,
    name TEXT,
    highway TEXT,
    direction TEXT NOT NULL,
    from_m DOUBLE NOT NULL,
    to_m DOUBLE NOT NULL,
    iri DOUBLE,
    iri_sd DOUBLE,
    iri_low DOUBLE,
    iri_high DOUBLE,
    iri_left DOUBLE,
    iri_right DOUBLE,
    "index" TEXT,
    class TEXT,
    passes INTEGER NOT NULL,
    vehicles INTEGER NOT NULL,
    first_seen DATETIME,
    last_seen DATETIME,
    trend_per_year DOUBLE,
    trend_sd DOUBLE,
    changed DATETIME,
    change DOUBLE,
    validity TEXT
);
)";

/// The fields' texts become numbers by the columns' affinity; only times are written another way.
void write_row(Statement& insert, const SegmentRecord& record, const ClassTable& classes) {
    const auto fields = segment_fields();
    auto values = field_values(record, classes);
    insert.bind(Blob{geometry_of(record.segment.line)});
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (fields[i].name == "first_seen" && record.state && record.state->first_seen_ms) {
            values[i] = datetime_text(*record.state->first_seen_ms);
        } else if (fields[i].name == "last_seen" && record.state && record.state->last_seen_ms) {
            values[i] = datetime_text(*record.state->last_seen_ms);
        } else if (fields[i].name == "changed" && record.state && record.state->change) {
            values[i] = datetime_text(record.state->change->utc_ms);
        }
        insert.bind_at(static_cast<int>(i) + 2, values[i]);
    }
    insert.step();
}

std::size_t write_geopackage(const RoadStore& store,
                             const SegmentFilter& filter,
                             const std::filesystem::path& temporary,
                             const std::filesystem::path& file,
                             const Progress& progress) {
    Database database{temporary, Database::Access::create, file};
    add_geometry_functions(database);
    Transaction all{database, Transaction::Kind::write};
    make_geopackage(database);
    database.run(roughness_table);
    GeoBox box;
    std::size_t written = 0;
    {
        auto insert = database.prepare(
            "INSERT INTO roughness VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,"
            " ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
        written = each(store, filter, progress, [&](const SegmentRecord& record) {
            write_row(insert, record, classes_of(store));
            for (const auto& point : record.segment.line) {
                box = including(box, point);
            }
        });
    }
    list_features(database,
                  {"roughness",
                   "roughness",
                   fmt::format("Roughness (IRI, mm/m). {}", store.settings().attribution),
                   is_empty(box) ? store.info().box : box});
    index_features(database, "roughness");
    add_default_style(database, "roughness", classes_of(store));
    all.commit();
    return written;
}

// ---------------------------------------------------------------------------------- FlatGeobuf

std::vector<FlatGeobufColumn> flatgeobuf_columns() {
    using Type = FlatGeobufColumn::Type;
    std::vector<FlatGeobufColumn> columns;
    for (const auto& field : segment_fields()) {
        const bool is_time = field.name == "first_seen" || field.name == "last_seen";
        columns.push_back({field.name,
                           is_time                           ? Type::time
                           : field.type == Field::Type::text ? Type::text
                           : field.type == Field::Type::real ? Type::real
                                                             : Type::integer});
    }
    return columns;
}

std::size_t write_flatgeobuf(const RoadStore& store,
                             const SegmentFilter& filter,
                             const std::filesystem::path& temporary,
                             const std::filesystem::path& file,
                             const Progress& progress) {
    auto* const write = late_function<FlatGeobufWrite>("macadam_gdal.so", flatgeobuf_write_name);
    auto with_suffix = temporary; // GDAL makes a folder for a name without it
    with_suffix += ".fgb";
    const FlatGeobufLayer layer{
        .file = with_suffix,
        .name = "roughness",
        .description = fmt::format("Roughness (IRI, mm/m). {}", store.settings().attribution),
        .columns = flatgeobuf_columns()};
    std::size_t written = 0;
    try {
        write(layer, [&](const FlatGeobufPut& put) {
            written = each(store, filter, progress, [&](const SegmentRecord& record) {
                put(record.segment.line, field_values(record, classes_of(store)));
            });
        });
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}", file.string(), error.what())};
    }
    std::filesystem::rename(with_suffix, temporary);
    return written;
}

std::size_t write_as(std::string_view suffix,
                     const RoadStore& store,
                     const SegmentFilter& filter,
                     const std::filesystem::path& file,
                     AtomicFile& out,
                     const Progress& progress) {
    if (suffix == ".geojson") {
        return write_geojson(store, filter, out, progress);
    }
    if (suffix == ".geojsonl") {
        return write_geojson_lines(store, filter, out, progress);
    }
    if (suffix == ".csv") {
        return write_csv(store, filter, out, progress);
    }
    if (suffix == ".fgb") {
        return write_flatgeobuf(store, filter, out.temporary(), file, progress);
    }
    return write_geopackage(store, filter, out.temporary(), file, progress);
}

} // namespace

std::span<const std::string_view> export_suffixes() {
    return suffixes;
}

std::size_t export_segments(const RoadStore& store,
                            const SegmentFilter& filter,
                            const std::filesystem::path& file,
                            const Progress& progress) {
    const auto suffix = file.extension().string();
    if (std::find(suffixes.begin(), suffixes.end(), suffix) == suffixes.end()) {
        throw InputError{fmt::format("{}: suffix '{}', expected one of {}",
                                     file.string(),
                                     suffix,
                                     fmt::join(suffixes, ", "))};
    }
    AtomicFile out{file};
    const auto written = write_as(suffix, store, filter, file, out, progress);
    if (suffix == ".gpkg") {
        remove_leftovers_of(file);
    }
    out.commit();
    return written;
}

} // namespace macadam
