#include "storage/store/copy/cut_out.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/store/background/background_rows.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/store/schema/new_store.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

namespace macadam {
namespace {

struct Column {
    const char* table;
    const char* name;
};

/// Columns that refer to segments, or to chunks by their first segments.
constexpr std::array segment_columns{Column{"pass", "segment"},
                                     Column{"trace", "strip"},
                                     Column{"event", "segment"},
                                     Column{"segment_state", "fid"},
                                     Column{"strip_state", "strip"},
                                     Column{"segment_dirty", "segment"},
                                     Column{"strip_dirty", "strip"},
                                     Column{"valid_from", "segment"},
                                     Column{"state_change", "segment"},
                                     Column{"published_state", "fid"},
                                     Column{"published_until", "segment"},
                                     Column{"published_pending", "segment"},
                                     Column{"published_figure", "segment"},
                                     Column{"published_event", "segment"}};
constexpr std::array trip_columns{
    Column{"trip", "id"}, Column{"row_reason", "trip"}, Column{"event_search", "trip"}};
constexpr std::array car_columns{Column{"vehicle", "id"},
                                 Column{"calibration", "vehicle"},
                                 Column{"calibration_period", "vehicle"}};
constexpr std::array tables_of_all{"meta", "fusion_setting", "forgotten", "publication"};

constexpr const char* select_trips =
    "SELECT trip FROM pass UNION SELECT trip FROM trace ORDER BY 1";
constexpr const char* select_cars =
    "SELECT DISTINCT vehicle FROM trip WHERE vehicle IS NOT NULL ORDER BY 1";

/// Copies rows of a table to the same table of another database.
class TableCopy {
public:
    /// \param condition  of SQL, of our own, with parameters
    TableCopy(Database& from, Database& to, const char* table, const std::string& condition)
        : select_{from.prepare(fmt::format("SELECT * FROM {} WHERE {}", table, condition))},
          insert_{to, fmt::format("INSERT INTO {}", table), select_.column_count()} {}

    /// Copies the rows for these parameters.
    template <typename... Values>
    void copy(const Values&... values) {
        for (select_.bind(values...); select_.step();) {
            insert_.add_row(select_);
        }
    }

    void finish() { insert_.flush(); }

private:
    Statement select_;
    BulkInsert insert_;
};

std::vector<std::int64_t> numbers_in(Database& database, const char* sql) {
    std::vector<std::int64_t> numbers;
    for (auto select = database.prepare(sql); select.step();) {
        numbers.push_back(select.integer(0));
    }
    return numbers;
}

/// Network of some ways and of those that have a node of them.
RoadNetwork roads_around(StoreConnection& source,
                         const std::unordered_set<std::int64_t>& ways,
                         std::span<const std::int64_t> ways_around) {
    auto around = read_ways(source.database, ways_around);
    std::unordered_set<std::int64_t> nodes;
    for (const auto& way : around) {
        if (ways.contains(way.id)) {
            nodes.insert(way.node_ids.begin(), way.node_ids.end());
        }
    }
    std::erase_if(around, [&](const Way& way) {
        return std::ranges::none_of(way.node_ids,
                                    [&](std::int64_t node) { return nodes.contains(node); });
    });
    return build_network(std::move(around), source.settings.segment_length_m);
}

class Cut {
public:
    Cut(StoreConnection& source,
        const CutContent& content,
        Database& file,
        const Progress& progress)
        : source_{&source}, content_{&content}, file_{&file}, progress_{&progress} {}

    /// \returns the box around all segments.
    GeoBox fill() {
        for (const auto* const table : tables_of_all) {
            copy_rows(table, "true");
        }
        const auto ways = ways_of(source_->database, content_->chunks);
        const auto roads =
            roads_around(*source_, {ways.begin(), ways.end()}, content_->ways_around);
        fill_roads(roads, ways);
        copy_each(segment_columns);
        copy_each(trip_columns, numbers_in(*file_, select_trips));
        copy_each(car_columns, numbers_in(*file_, select_cars));
        copy_each(std::array{Column{"audit", "id"}},
                  numbers_in(*file_, "SELECT DISTINCT audit FROM state_change ORDER BY 1"));
        copy_rows("background", tiles_in(content_->ground));
        copy_rows("place", places_in(content_->ground));
        add_audit(*file_, "cut", content_->from);
        return extent_of(roads);
    }

private:
    TableCopy table(const char* name, const std::string& condition) {
        return {source_->database, *file_, name, condition};
    }

    void copy_rows(const char* name, const std::string& condition) {
        auto rows = table(name, condition);
        rows.copy();
        rows.finish();
    }

    /// Copies the rows of tables that name one of some rows of another table.
    void copy_each(std::span<const Column> columns, std::span<const std::int64_t> ids) {
        for (const auto& [name, column] : columns) {
            auto rows = table(name, fmt::format("{} = ?", column));
            for (const auto id : ids) {
                rows.copy(id);
            }
            rows.finish();
        }
    }

    /// Copies the rows of tables that name a segment of the chunks.
    void copy_each(std::span<const Column> columns) {
        std::size_t done = 0;
        for (const auto& [name, column] : columns) {
            auto rows = table(name, fmt::format("{0} >= ? AND {0} <= ?", column));
            for (const auto& [first, last] : content_->chunks) {
                rows.copy(first, last);
                report(++done, columns.size() * content_->chunks.size());
            }
            rows.finish();
        }
    }

    void report(std::size_t done, std::size_t all) {
        if (progress_->stop.stop_requested()) {
            throw InputError{
                fmt::format("{}: interrupted; nothing was written", file_->file().string())};
        }
        if (constexpr std::size_t step = 1000; done % step == 0) {
            (*progress_)(done, all);
        }
    }

    /// Fills the tables of roads; segments of ways of chunks keep their rows.
    void fill_roads(const RoadNetwork& roads, std::span<const std::int64_t> ways) {
        const auto hash = write_ways(*file_, roads);
        copy_each(std::array{Column{"segment", "way_id"}}, ways);
        copy_control_sections(ways);
        std::vector<bool> stay;
        std::vector<std::int64_t> all;
        for (std::uint32_t i = 0; i < way_count(roads); ++i) {
            all.push_back(way_at(roads, i).id);
            stay.push_back(std::ranges::binary_search(ways, all.back()));
        }
        copy_each(std::array{Column{"road_ref", "way_id"}}, all);
        reserve_published_rows(*file_);
        write_segments(*file_, roads, {.report = {}, .stop = progress_->stop}, stay);
        const auto segments = count_segments(roads);
        if (file_->number("SELECT count(*) FROM segment") != segments.segments) {
            throw InputError{fmt::format("{}: the segments of its roads are not those of its ways; "
                                         "the database was modified by another program",
                                         source_->database.file().string())};
        }
        const auto& settings = source_->settings;
        update_network_meta(*file_,
                            {settings.network_source,
                             settings.attribution,
                             hash,
                             segments.segments,
                             segments.length_m});
    }

    /// Sections have no index by way.
    void copy_control_sections(std::span<const std::int64_t> ways) {
        auto select = source_->database.prepare("SELECT DISTINCT way_id FROM control_section");
        std::vector<std::int64_t> with_sections;
        while (select.step()) {
            if (std::ranges::binary_search(ways, select.integer(0))) {
                with_sections.push_back(select.integer(0));
            }
        }
        copy_each(std::array{Column{"control_section", "way_id"}}, with_sections);
    }

    StoreConnection* source_;
    const CutContent* content_;
    Database* file_;
    const Progress* progress_;
};

} // namespace

std::vector<std::int64_t> ways_of(Database& source, std::span<const ChunkRows> chunks) {
    std::vector<std::int64_t> ways;
    auto select = source.prepare("SELECT way_id FROM segment WHERE fid = ?");
    for (const auto& chunk : chunks) {
        if (select.bind(chunk.first).step()) {
            ways.push_back(select.integer(0));
        }
    }
    std::ranges::sort(ways);
    ways.erase(std::ranges::unique(ways).begin(), ways.end());
    return ways;
}

void cut_out(StoreConnection& source,
             const CutContent& content,
             Database& file,
             const Progress& progress) {
    add_geometry_functions(file);
    fill_new_store(file, source.settings.class_table, source.settings.privacy, [&] {
        return Cut{source, content, file, progress}.fill();
    });
}

} // namespace macadam
