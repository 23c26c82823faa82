#include "storage/exports/segment_export.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "mapping/geometry/antimeridian.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/exports/flatgeobuf_index.hpp"
#include "storage/exports/style_files.hpp"
#include "storage/gdal/ogr_line_writer.hpp"
#include "storage/styles/road_style.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

using Type = LineFileColumn::Type;
using Kind = ColumnType::Kind;

std::size_t write_lines(const SegmentExport& what,
                        const LineFile& file,
                        const std::function<LineParts(const SegmentRecord&)>& shape_of) {
    auto* const write = plugin_function<LineFileWrite>("macadam_gdal.so", line_file_write_name);
    std::size_t written = 0;
    try {
        write(file, [&](const LinePut& put) {
            written = each_segment(what, [&](const SegmentRecord& record) {
                put(shape_of(record), attribute_texts({record, what.classes}, what.attributes));
            });
        });
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}", what.file.string(), error.what())};
    }
    return written;
}

// ---------------------------------------------------------------------------------- FlatGeobuf

std::vector<LineFileColumn> flatgeobuf_columns(const Columns<ClassedSegment>& attributes) {
    std::vector<LineFileColumn> columns;
    for (const auto& [name, type, value, shown] : attributes) {
        columns.push_back({name,
                           type.kind == Kind::real      ? Type::real
                           : type.kind == Kind::integer ? Type::integer
                                                        : Type::text});
    }
    return columns;
}

// ----------------------------------------------------------------------------------- Shapefile

// ESRI Shapefile Technical Description (1998), pp. 4-10: a file header of 100 bytes; 8 bytes before
// each record; for a PolyLine, 44 bytes plus 4 per part and 16 per point. dBASE III: 32 bytes of
// header and 32 per column, an end mark, a deletion mark before each row, and an end mark.
constexpr std::uint64_t shp_header_bytes = 100;
constexpr std::uint64_t shp_record_bytes = 8 + 44;
constexpr std::uint64_t shp_part_bytes = 4;
constexpr std::uint64_t shp_point_bytes = 16;
constexpr std::uint64_t shx_record_bytes = 8;
constexpr std::uint64_t dbf_header_bytes = 33;
constexpr std::uint64_t dbf_end_bytes = 1;
constexpr std::uint64_t dbf_column_bytes = 32;
constexpr std::uint64_t max_file_bytes = std::numeric_limits<std::int32_t>::max();

constexpr int max_text_bytes = 254; // of a character column
constexpr int day_bytes = 8;
constexpr int integer_bytes = 18; // with more digits, GDAL reads the column as real numbers
constexpr int real_bytes = 13;    // 2147483.647 mm/m, and positions along a way of any length

/// Sizes that must be known before the first row of a Shapefile.
struct Measure {
    std::uint64_t shp_bytes = shp_header_bytes;
    std::uint64_t rows = 0;
    std::array<std::size_t, 32> widest{}; ///< max bytes of each field
    std::optional<std::int64_t> last_seen_ms;
};

Measure measured(const SegmentExport& what) {
    Measure measure;
    measure.rows = each_segment(what, [&](const SegmentRecord& record) {
        measure.shp_bytes += shp_record_bytes;
        for (const auto& part : cut_at_antimeridian(record.segment.line)) {
            measure.shp_bytes += shp_part_bytes + part.size() * shp_point_bytes;
        }
        const auto values = attribute_texts({record, what.classes}, what.attributes);
        for (std::size_t i = 0; i < values.size(); ++i) {
            measure.widest[i] = std::max(measure.widest[i], values[i] ? values[i]->size() : 0);
        }
        if (record.state && record.state->last_seen_ms) {
            measure.last_seen_ms = std::max(measure.last_seen_ms, record.state->last_seen_ms);
        }
    });
    return measure;
}

LineFileColumn shapefile_column(const Column<ClassedSegment>& column, std::size_t widest) {
    const auto name = shapefile_name(column.name);
    switch (column.type.kind) {
    case Kind::day:
        return {name, Type::day, day_bytes};
    case Kind::integer:
        return {name, Type::integer, integer_bytes};
    case Kind::real:
        return {name, Type::real, real_bytes, column.type.decimals};
    default:
        break;
    }
    const auto width = std::clamp<std::size_t>(widest, 1, max_text_bytes);
    return {name, Type::text, static_cast<int>(width)};
}

std::vector<LineFileColumn> shapefile_columns(const SegmentExport& what, const Measure& measure) {
    std::vector<LineFileColumn> columns;
    for (const auto& column : what.attributes) {
        columns.push_back(shapefile_column(column, measure.widest[columns.size()]));
    }
    return columns;
}

std::uint64_t dbf_bytes(const Measure& measure, const std::vector<LineFileColumn>& columns) {
    std::uint64_t row_bytes = 1;
    for (const auto& column : columns) {
        row_bytes += static_cast<std::uint64_t>(column.width);
    }
    return dbf_header_bytes + columns.size() * dbf_column_bytes + measure.rows * row_bytes +
           dbf_end_bytes;
}

void expect_room(const SegmentExport& what,
                 const Measure& measure,
                 const std::vector<LineFileColumn>& columns) {
    const auto bytes = std::max(measure.shp_bytes, dbf_bytes(measure, columns));
    if (bytes > max_file_bytes) {
        throw InputError{fmt::format("{}: {} segments need a file of {:.1f} GB, expected at most "
                                     "the 2 GB of a Shapefile: choose fewer (--bbox), or .gpkg or "
                                     ".fgb",
                                     what.file.string(),
                                     measure.rows,
                                     static_cast<double>(bytes) / 1e9)};
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].type == Type::integer && measure.widest[i] > std::size_t{integer_bytes}) {
            throw InputError{fmt::format("{}: a {} has {} digits, expected at most the {} of a "
                                         "Shapefile: choose .gpkg or .fgb",
                                         what.file.string(),
                                         columns[i].name,
                                         measure.widest[i],
                                         integer_bytes)};
        }
    }
}

/// Modification day in the .dbf: that of the last pass, so that equal roads give equal bytes.
std::string day_of(const Measure& measure) {
    constexpr std::int64_t earliest_ms = -2'208'988'800'000; // 1900: the first year of a .dbf
    constexpr std::int64_t latest_ms = 5'837'097'599'999;    // 2154: the last year in one byte
    const auto utc_ms = std::clamp(measure.last_seen_ms.value_or(0), earliest_ms, latest_ms);
    return utc_day(utc_ms);
}

/// Indexes that other programs create beside a Shapefile; they do not match the new lines.
std::vector<std::string> stale_beside(const std::string& stem) {
    std::vector<std::string> names;
    for (const auto* suffix : {".qix", ".sbn", ".sbx", ".idm", ".ind", ".atx"}) {
        names.push_back(stem + suffix);
    }
    return names;
}

/// Checks the file sizes, which are known before the first row: GDAL does not report a Shapefile
/// that is truncated by a full disk, and its reader does not notice.
bool is_whole_shapefile(const std::filesystem::path& shp,
                        const Measure& measure,
                        const std::vector<LineFileColumn>& columns) {
    const auto has_bytes = [&](const char* suffix, std::uint64_t bytes) {
        auto file = shp;
        return std::filesystem::file_size(file.replace_extension(suffix)) == bytes;
    };
    return has_bytes(".shp", measure.shp_bytes) &&
           has_bytes(".shx", shp_header_bytes + measure.rows * shx_record_bytes) &&
           has_bytes(".dbf", dbf_bytes(measure, columns));
}

} // namespace

std::size_t export_flatgeobuf(const SegmentExport& what) {
    AtomicFileSet files{what.file};
    const auto place = files.folder() / what.file.filename();
    LineFile plain{.driver = "FlatGeobuf",
                   .file = files.folder() / "plain.fgb",
                   .layer = "roughness",
                   .options = {{"SPATIAL_INDEX", "NO"}, {"DESCRIPTION", description_of(what)}},
                   .columns = flatgeobuf_columns(what.attributes)};
    std::vector<GeoBox> boxes;
    const auto parts_of = [&](const SegmentRecord& record) -> LineParts {
        const auto& line = record.segment.line; // line layers have single-part lines only
        LineParts parts{crosses_antimeridian(line) ? unwrapped(line, line.front().lon_deg) : line};
        boxes.emplace_back();
        for (const auto& point : parts.front()) {
            boxes.back() = including(boxes.back(), point);
        }
        return parts;
    };
    const auto written = write_lines(what, plain, parts_of);
    if (written == 0) {
        // Without features, GDAL writes a header only if it is to write an index.
        plain.file = place;
        plain.options.front().second = "YES";
        write_lines(what, plain, parts_of);
    } else {
        try {
            index_flatgeobuf(plain.file, std::move(boxes), place);
        } catch (const InputError& error) {
            throw InputError{fmt::format("{}: {}", what.file.string(), error.what())};
        }
    }
    std::filesystem::remove(files.folder() / "plain.fgb");
    write_style_files(what.file, files.folder(), {what.classes, what.units});
    what.store.expect_in_place();
    files.commit();
    return written;
}

std::size_t export_shapefile(const SegmentExport& what) {
    const auto measure = measured(what);
    const auto columns = shapefile_columns(what, measure);
    expect_room(what, measure, columns);
    AtomicFileSet files{what.file};
    const auto stem = what.file.stem().string();
    const LineFile file{
        .driver = "ESRI Shapefile",
        .file = files.folder() / what.file.filename(),
        .layer = stem,
        .options = {{"ENCODING", "UTF-8"}, {"DBF_DATE_LAST_UPDATE", day_of(measure)}},
        .columns = columns};
    const auto written = write_lines(what, file, [](const SegmentRecord& record) {
        return cut_at_antimeridian(record.segment.line);
    });
    if (!is_whole_shapefile(file.file, measure, columns)) {
        throw InputError{
            fmt::format("{}: cannot be written; the disk may be full", what.file.string())};
    }
    write_style_files(what.file, files.folder(), {what.classes, what.units, FieldNames::shapefile});
    what.store.expect_in_place();
    files.commit(stale_beside(stem));
    return written;
}

} // namespace macadam
