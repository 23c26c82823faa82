#include "storage/store/server/server_rows.hpp"

#include "estimator/common/error.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

namespace macadam {
namespace {

std::optional<std::int32_t> known_um(const CopyRow& row, int column) {
    const auto value = row.known_integer(column);
    return value ? std::optional{static_cast<std::int32_t>(*value)} : std::nullopt;
}

} // namespace

SegmentKey segment_key_in(const CopyRow& row, int first) {
    return {row.integer(first),
            row.bytes(first + 1) == "forward",
            static_cast<std::uint32_t>(row.integer(first + 2))};
}

const char* const server_state_columns =
    "state.iri_um, state.sd_um, state.low_um, state.high_um, state.left_um, state.right_um,"
    " state.centre_only, state.flags, state.passes, state.vehicles, state.first_seen_ms,"
    " state.last_seen_ms, state.trend_um_per_year, state.trend_sd_um_per_year, state.changed_ms,"
    " state.change_um";

SegmentState server_state_in(const CopyRow& row, int first, const SegmentKey& segment) {
    const auto number = [&](int column) {
        return static_cast<std::int32_t>(row.integer(first + column));
    };
    const auto changed_ms = row.known_integer(first + 14);
    return {.segment = segment,
            .iri_um = number(0),
            .sd_um = number(1),
            .low_um = number(2),
            .high_um = number(3),
            .left_um = known_um(row, first + 4),
            .right_um = known_um(row, first + 5),
            .centre_only = row.boolean(first + 6),
            .validity = static_cast<std::uint8_t>(number(7)),
            .passes = number(8),
            .vehicles = number(9),
            .first_seen_ms = row.known_integer(first + 10),
            .last_seen_ms = row.known_integer(first + 11),
            .trend_um_per_year = known_um(row, first + 12),
            .trend_sd_um_per_year = known_um(row, first + 13),
            .change =
                changed_ms ? std::optional{RoadChange{*changed_ms, number(15)}} : std::nullopt};
}

void write_server_state(CopyWriter& writer,
                        std::int32_t cell,
                        std::int64_t fid,
                        const SegmentState& state,
                        const ClassTable& classes) {
    std::optional<std::int64_t> changed_ms;
    std::optional<IriUm> change;
    if (state.change) {
        changed_ms = state.change->utc_ms;
        change = state.change->um;
    }
    writer.add(cell,
               fid,
               state.iri_um,
               state.sd_um,
               state.low_um,
               state.high_um,
               state.left_um,
               state.right_um,
               state.centre_only,
               std::int32_t{state.validity},
               name_of_validity(state.validity),
               state.passes,
               state.vehicles,
               state.first_seen_ms,
               state.last_seen_ms,
               state.trend_um_per_year,
               state.trend_sd_um_per_year,
               changed_ms,
               change,
               classes.classes[class_index(classes, mm_per_m(state.iri_um))].name);
}

void put_row(CopyWriter& writer, const Statement& row, const ServerTable& table) {
    writer.begin_row();
    for (int column = 0; column < static_cast<int>(table.columns.size()); ++column) {
        const std::string_view type{table.columns[static_cast<std::size_t>(column)].type};
        if (row.is_null(column)) {
            writer.put(std::nullopt);
        } else if (type.starts_with("bigint")) {
            writer.put(row.integer(column));
        } else if (type.starts_with("double")) {
            writer.put(row.real(column));
        } else if (type.starts_with("bytea")) {
            writer.put(ServerBytes{row.blob(column)});
        } else {
            writer.put(row.text(column));
        }
    }
    writer.end_row();
}

void put_row(Statement& insert, const CopyRow& row, const ServerTable& table) {
    insert.reset();
    for (int column = 0; column < static_cast<int>(table.columns.size()); ++column) {
        const std::string_view type{table.columns[static_cast<std::size_t>(column)].type};
        if (row.is_null(column)) {
            insert.bind_at(column + 1, std::nullopt);
        } else if (type.starts_with("bigint")) {
            insert.bind_at(column + 1, row.integer(column));
        } else if (type.starts_with("double")) {
            insert.bind_at(column + 1, row.real(column));
        } else if (type.starts_with("bytea")) {
            insert.bind_at(column + 1, Blob{row.bytes(column)});
        } else {
            insert.bind_at(column + 1, row.bytes(column));
        }
    }
    insert.step();
    insert.reset();
}

void continue_row_numbers(ServerConnection& server, const std::string& table) {
    server.rows(fmt::format("SELECT setval(pg_get_serial_sequence('macadam.{0}', 'id'),"
                            " coalesce((SELECT max(id) FROM macadam.{0}), 0) + 1, false)",
                            table));
}

std::vector<DrivePass> server_passes_in(const ServerConnection& server,
                                        std::string_view body,
                                        std::uint32_t segments_per_chunk) {
    try {
        return passes_in_body(body, segments_per_chunk);
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}; the database was modified by another program",
                                     server.address(),
                                     error.what())};
    }
}

std::string wanted_chunks(std::span<const ServerChunk> chunks) {
    std::vector<std::int64_t> cells, rows;
    for (const auto& [cell, row] : chunks) {
        cells.push_back(cell);
        rows.push_back(row);
    }
    return fmt::format("unnest('{}'::integer[], '{}'::bigint[]) AS wanted (cell, chunk)",
                       array_of(cells),
                       array_of(rows));
}

std::string
join_each(std::string_view table, std::string_view alias, const std::string& condition) {
    return fmt::format(" CROSS JOIN LATERAL (SELECT * FROM macadam.{0} AS {1} WHERE {2} OFFSET 0)"
                       " AS {1}",
                       table,
                       alias,
                       condition);
}

std::string join_segments(std::uint32_t segments_per_chunk) {
    return join_each("segment",
                     "segment",
                     fmt::format("segment.cell = wanted.cell AND segment.fid >= wanted.chunk AND"
                                 " segment.fid < wanted.chunk + {} AND segment.chunk ="
                                 " wanted.chunk",
                                 segments_per_chunk));
}

std::string join_states(std::uint32_t segments_per_chunk) {
    // From chunks to states, which another server may have: one question a chunk.
    return fmt::format(" CROSS JOIN LATERAL (SELECT max(fid) AS fid FROM macadam.segment WHERE cell"
                       " = wanted.cell AND fid >= wanted.chunk AND fid < wanted.chunk + {} AND"
                       " chunk = wanted.chunk) AS last",
                       segments_per_chunk) +
           join_each("segment_state",
                     "state",
                     "state.cell = wanted.cell AND state.fid BETWEEN wanted.chunk AND last.fid") +
           join_each("segment", "segment", "segment.cell = state.cell AND segment.fid = state.fid");
}

void expect_no_stop(const ServerConnection& server, const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{fmt::format("{}: interrupted; nothing was written", server.address())};
    }
}

} // namespace macadam
