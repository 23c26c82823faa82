#include "storage/exports/export.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/exports/segment_export.hpp"
#include "storage/exports/style_files.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 7> suffixes{
    ".geojson", ".geojsonl", ".csv", ".gpkg", ".fgb", ".shp", ".kml"};

std::size_t write_geojson(const SegmentExport& what, const PutText& put) {
    put(R"({"type":"FeatureCollection","name":"roughness","attribution":)" +
        json_text(what.store.settings().attribution) + ",\"features\":[");
    const char* separator = "\n";
    const auto written = each_segment(what, [&](const SegmentRecord& record) {
        put(separator + geojson_feature({record, what.classes}, what.columns));
        separator = ",\n";
    });
    put("\n]}\n");
    return written;
}

std::size_t write_geojson_lines(const SegmentExport& what, const PutText& put) {
    return each_segment(what, [&](const SegmentRecord& record) {
        put(geojson_feature({record, what.classes}, what.columns) + "\n");
    });
}

std::size_t write_csv(const SegmentExport& what, const PutText& put) {
    const auto& columns = what.columns;
    put(csv_header(columns));
    return each_segment(what, [&](const SegmentRecord& record) {
        put(csv_line(columns, {record, what.classes}));
    });
}

/// Returns `put` behind the dialect of a CSV file.
PutText in_dialect(const PutText& put, std::string_view suffix, const TextExport& text) {
    if (!text.excel || suffix != ".csv") {
        return put;
    }
    return [put, excel = std::make_shared<ExcelCsv>(*text.excel)](std::string_view csv) {
        put((*excel)(csv));
    };
}

std::size_t write_as(std::string_view suffix, const SegmentExport& what, const PutText& put) {
    if (suffix == ".geojson") {
        return write_geojson(what, put);
    }
    if (suffix == ".geojsonl") {
        return write_geojson_lines(what, put);
    }
    if (suffix == ".csv") {
        return write_csv(what, put);
    }
    return write_kml(what, put);
}

std::size_t export_as(std::string_view suffix, const SegmentExport& what, const TextExport& text) {
    if (suffix == ".fgb") {
        return export_flatgeobuf(what);
    }
    if (suffix == ".shp") {
        return export_shapefile(what);
    }
    if (suffix == ".gpkg") {
        return export_geopackage(what);
    }
    if (text.put) {
        const auto written = write_as(suffix, what, in_dialect(text.put, suffix, text));
        what.store.expect_in_place();
        return written;
    }
    AtomicFile out{what.file};
    const auto written = write_as(
        suffix, what, in_dialect([&](std::string_view more) { out.write(more); }, suffix, text));
    what.store.expect_in_place();
    if (suffix != ".geojson") {
        out.commit();
        return written;
    }
    AtomicFileSet styles{what.file}; // complete before anything appears
    write_style_files(what.file, styles.folder(), {what.classes, text.units});
    out.commit();
    styles.commit();
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
    return fmt::format("Roughness (IRI, {}). {}",
                       what.units == UnitSystem::us ? "in/mi" : "mm/m",
                       what.store.settings().attribution);
}

bool is_text_suffix(std::string_view suffix) {
    constexpr std::array<std::string_view, 4> texts{".geojson", ".geojsonl", ".csv", ".kml"};
    return std::ranges::find(texts, suffix) != texts.end();
}

std::span<const std::string_view> export_suffixes() {
    return suffixes;
}

std::size_t export_segments(const StoreReader& store,
                            const SegmentFilter& filter,
                            const std::filesystem::path& file,
                            const Progress& progress,
                            const TextExport& text) {
    const auto suffix = file.extension().string();
    if (std::find(suffixes.begin(), suffixes.end(), suffix) == suffixes.end()) {
        throw InputError{fmt::format("{}: suffix '{}', expected one of {}",
                                     file.string(),
                                     suffix,
                                     fmt::join(suffixes, ", "))};
    }
    const SegmentExport what{store,
                             filter,
                             file,
                             progress,
                             *class_table(store.settings().class_table),
                             text.units,
                             in_units(segment_columns(), text.units),
                             in_units(segment_attributes(), text.units)};
    return export_as(suffix, what, text);
}

} // namespace macadam
