#include "storage/exports/export.hpp"

#include "estimator/common/error.hpp"
#include "storage/exports/segment_export.hpp"
#include "storage/exports/style_files.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 7> suffixes{
    ".geojson", ".geojsonl", ".csv", ".gpkg", ".fgb", ".shp", ".kml"};

std::size_t write_geojson(const SegmentExport& what, AtomicFile& file) {
    file.write(R"({"type":"FeatureCollection","name":"roughness","attribution":)" +
               json_text(what.store.settings().attribution) + ",\"features\":[");
    const char* separator = "\n";
    const auto written = each_segment(what, [&](const SegmentRecord& record) {
        file.write(separator + geojson_feature({record, what.classes}));
        separator = ",\n";
    });
    file.write("\n]}\n");
    return written;
}

std::size_t write_geojson_lines(const SegmentExport& what, AtomicFile& file) {
    return each_segment(what, [&](const SegmentRecord& record) {
        file.write(geojson_feature({record, what.classes}) + "\n");
    });
}

std::size_t write_csv(const SegmentExport& what, AtomicFile& file) {
    const auto& columns = segment_columns();
    file.write(csv_header(columns));
    return each_segment(what, [&](const SegmentRecord& record) {
        file.write(csv_line(columns, {record, what.classes}));
    });
}

std::size_t write_as(std::string_view suffix, const SegmentExport& what, AtomicFile& file) {
    if (suffix == ".geojson") {
        return write_geojson(what, file);
    }
    if (suffix == ".geojsonl") {
        return write_geojson_lines(what, file);
    }
    if (suffix == ".csv") {
        return write_csv(what, file);
    }
    return write_kml(what, file);
}

std::size_t export_as(std::string_view suffix, const SegmentExport& what) {
    if (suffix == ".fgb") {
        return export_flatgeobuf(what);
    }
    if (suffix == ".shp") {
        return export_shapefile(what);
    }
    if (suffix == ".gpkg") {
        return export_geopackage(what);
    }
    AtomicFile out{what.file};
    const auto written = write_as(suffix, what, out);
    what.store.expect_in_place();
    if (suffix == ".geojson") {
        write_style_files(what.file, what.file.parent_path(), what.classes);
    }
    out.commit();
    return written;
}

} // namespace

std::size_t each_segment(const SegmentExport& what,
                         const std::function<void(const SegmentRecord&)>& write) {
    constexpr std::size_t report_every = 1000;
    std::size_t written = 0;
    what.store.visit(what.filter, [&](const SegmentRecord& record) {
        write(record);
        if (++written % report_every == 0) {
            what.progress(written, 0);
        }
        if (what.progress.stop.stop_requested()) {
            throw InputError{"stopped before the file was complete"};
        }
    });
    return written;
}

std::string description_of(const SegmentExport& what) {
    return fmt::format("Roughness (IRI, mm/m). {}", what.store.settings().attribution);
}

std::span<const std::string_view> export_suffixes() {
    return suffixes;
}

std::size_t export_segments(const StoreReader& store,
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
    const SegmentExport what{
        store, filter, file, progress, *class_table(store.settings().class_table)};
    return export_as(suffix, what);
}

} // namespace macadam
