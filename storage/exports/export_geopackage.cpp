#include "storage/exports/segment_export.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/exports/feature_table.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/geopackage/qgis_style.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace macadam {
namespace {

/// Line with continuous longitudes across the antimeridian, because the table does not allow
/// multi-part lines.
std::vector<GeoPoint> smooth_line(const SegmentRecord& record) {
    const auto& line = record.segment.line;
    return crosses_antimeridian(line) ? unwrapped(line, line.front().lon_deg) : line;
}

/// Writes a row; column affinity converts the texts to numbers.
void write_row(Statement& insert,
               const SegmentRecord& record,
               std::span<const GeoPoint> line,
               const SegmentExport& what) {
    const auto values = attribute_texts({record, what.classes}, what.attributes);
    insert.bind(Blob{geometry_of(line)});
    for (std::size_t i = 0; i < values.size(); ++i) {
        insert.bind_at(static_cast<int>(i) + 2, values[i]);
    }
    insert.step();
}

/// Dates the database by its last pass, not by the time of the export, so that equal roads give
/// equal bytes.
void date_by_content(Database& database, const ObservedPeriod& seen) {
    const auto day = utc_text(seen.last_ms.value_or(0)).substr(0, 10);
    const auto time = day + "T00:00:00.000Z";
    database.prepare("UPDATE gpkg_contents SET last_change = ?").run(time);
    database.prepare("UPDATE layer_styles SET update_time = ?").run(time);
}

std::size_t write_geopackage(const SegmentExport& what, const std::filesystem::path& file) {
    Database database{file, Database::Access::create, what.file};
    add_geometry_functions(database);
    Transaction all{database, Transaction::Kind::write};
    make_geopackage(database);
    database.run(feature_table("roughness", "LINESTRING", what.attributes));
    GeoBox box;
    std::size_t written = 0;
    {
        auto insert = database.prepare(feature_insert("roughness", what.attributes));
        written = each_segment(what, [&](const SegmentRecord& record) {
            const auto line = smooth_line(record);
            write_row(insert, record, line, what);
            for (const auto& point : line) {
                box = including(box, point);
            }
        });
    }
    list_features(database,
                  {"roughness",
                   "roughness",
                   description_of(what),
                   is_empty(box) ? what.store.info().box : box});
    index_features(database, "roughness");
    add_style_table(database);
    add_default_style(database, "roughness", {what.classes, what.units});
    date_by_content(database, what.store.seen());
    all.commit();
    return written;
}

} // namespace

std::size_t export_geopackage(const SegmentExport& what) {
    AtomicFileSet files{what.file};
    const auto written = write_geopackage(what, files.main_file());
    what.store.expect_in_place();
    remove_leftovers_of(what.file);
    files.commit();
    return written;
}

} // namespace macadam
