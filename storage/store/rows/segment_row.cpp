#include "storage/store/rows/segment_row.hpp"

#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/text/utc.hpp"

#include <cmath>

namespace macadam {
namespace {

std::optional<double> known_mm_per_m(const std::optional<IriUm>& um) {
    return um ? std::optional{mm_per_m(*um)} : std::nullopt;
}

template <typename Row>
IriUm um_in(const Row& row, int column) {
    return static_cast<IriUm>(std::lround(row.real(column) * 1000));
}

template <typename Row>
std::optional<IriUm> known_um_in(const Row& row, int column) {
    return row.is_null(column) ? std::nullopt : std::optional{um_in(row, column)};
}

std::optional<std::string> known_day(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? std::optional{utc_day(*utc_ms)} : std::nullopt;
}

std::optional<IriUm> known_whole_in(const Statement& row, int column) {
    return row.is_null(column) ? std::nullopt
                               : std::optional{static_cast<IriUm>(row.integer(column))};
}

constexpr std::int64_t first_utc_ms = -62'135'596'800'000; // 0001-01-01T00:00:00Z
constexpr std::int64_t last_utc_ms = 253'402'300'799'999;  // 9999-12-31T23:59:59.999Z

std::optional<std::int64_t> unless_absurd(std::int64_t utc_ms) {
    return utc_ms >= first_utc_ms && utc_ms <= last_utc_ms ? std::optional{utc_ms} : std::nullopt;
}

template <typename Row>
std::optional<std::int64_t> known_time_in(const Row& row, int column) {
    return row.is_null(column) ? std::nullopt : unless_absurd(row.integer(column));
}

template <typename Row>
std::optional<RoadChange> known_change_in(const Row& row, int column) {
    const auto utc_ms = known_time_in(row, column);
    return utc_ms ? std::optional{RoadChange{*utc_ms, um_in(row, column + 1)}} : std::nullopt;
}

// Enumerations are compared as bytes, without creating strings.

/// Reads the first three columns.
template <typename Row>
SegmentKey key_in(const Row& row) {
    return {row.integer(0), row.blob(1) == "forward", static_cast<std::uint32_t>(row.integer(2))};
}

constexpr int first_state_column = 6;

template <typename Row>
SegmentState state_in(const Row& row, const SegmentKey& segment) {
    constexpr int c = first_state_column;
    return {.segment = segment,
            .iri_um = um_in(row, c),
            .sd_um = um_in(row, c + 1),
            .low_um = um_in(row, c + 2),
            .high_um = um_in(row, c + 3),
            .left_um = known_um_in(row, c + 4),
            .right_um = known_um_in(row, c + 5),
            .centre_only = row.blob(c + 6) != "MRI",
            .validity = static_cast<std::uint8_t>(row.integer(c + 15)),
            .passes = static_cast<std::int32_t>(row.integer(c + 7)),
            .vehicles = static_cast<std::int32_t>(row.integer(c + 8)),
            .first_seen_ms = known_time_in(row, c + 9),
            .last_seen_ms = known_time_in(row, c + 10),
            .trend_um_per_year = known_um_in(row, c + 11),
            .trend_sd_um_per_year = known_um_in(row, c + 12),
            .change = known_change_in(row, c + 13)};
}

/// Reads the columns before those of the state.
template <typename Row>
void put_segment(const Row& row, Segment& segment) {
    segment.key = key_in(row);
    segment.from_m = row.real(3);
    segment.to_m = row.real(4);
    put_line_of_geometry(row.blob(5), segment.line);
}

template <typename Row>
void put_record(const Row& row, SegmentRecord& record) {
    put_segment(row, record.segment);
    if (row.is_null(first_state_column)) {
        record.state.reset();
    } else {
        record.state = state_in(row, record.segment.key);
    }
}

} // namespace

const char* const record_columns =
    "segment.way_id, segment.direction, segment.seq, segment.from_m, segment.to_m, segment.geom,"
    " state.iri, state.iri_sd, state.iri_low, state.iri_high,"
    " state.iri_left, state.iri_right, state.\"index\", state.passes, state.vehicles,"
    " state.first_seen_ms, state.last_seen_ms, state.trend_per_year, state.trend_sd,"
    " state.changed_ms, state.change, state.flags";

SegmentRecord record_in(const Statement& row) {
    SegmentRecord record;
    put_record(row, record);
    return record;
}

void put_record_in(const VisitedRow& row, SegmentRecord& record) {
    put_record(row, record);
}

const char* const tile_columns =
    "segment.way_id, segment.direction, segment.seq, segment.from_m, segment.to_m, segment.geom,"
    " state.iri, state.iri_sd, state.iri_low, state.iri_high, state.passes, state.vehicles,"
    " state.first_seen_ms, state.last_seen_ms, state.trend_per_year, state.flags";

void put_tile_record_in(const VisitedRow& row, SegmentRecord& record) {
    constexpr int c = first_state_column;
    put_segment(row, record.segment);
    record.state.reset();
    if (!row.is_null(c)) {
        auto& state = record.state.emplace();
        state.segment = record.segment.key;
        state.iri_um = um_in(row, c);
        state.sd_um = um_in(row, c + 1);
        state.low_um = um_in(row, c + 2);
        state.high_um = um_in(row, c + 3);
        state.passes = static_cast<std::int32_t>(row.integer(c + 4));
        state.vehicles = static_cast<std::int32_t>(row.integer(c + 5));
        state.first_seen_ms = known_time_in(row, c + 6);
        state.last_seen_ms = known_time_in(row, c + 7);
        state.trend_um_per_year = known_um_in(row, c + 8);
        state.validity = static_cast<std::uint8_t>(row.integer(c + 9));
    }
}

const char* const summary_columns = "segment.way_id, segment.direction, segment.seq, segment.geom,"
                                    " state.iri, state.iri_sd, state.passes";

void put_summary_in(const VisitedRow& row, SegmentRecord& record) {
    constexpr int c = 4;
    record.segment.key = key_in(row);
    put_line_of_geometry(row.blob(3), record.segment.line);
    record.state.reset();
    if (!row.is_null(c)) {
        auto& state = record.state.emplace();
        state.segment = record.segment.key;
        state.iri_um = um_in(row, c);
        state.sd_um = um_in(row, c + 1);
        state.passes = static_cast<std::int32_t>(row.integer(c + 2));
    }
}

const char* const insert_state = "INSERT OR REPLACE INTO segment_state";

void write_state(BulkInsert& insert,
                 std::int64_t fid,
                 const SegmentState& state,
                 const ClassTable& classes) {
    const double iri = mm_per_m(state.iri_um);
    std::optional<std::int64_t> changed_ms;
    std::optional<double> change;
    if (state.change) {
        changed_ms = state.change->utc_ms;
        change = mm_per_m(state.change->um);
    }
    insert.add(fid,
               iri,
               mm_per_m(state.sd_um),
               mm_per_m(state.low_um),
               mm_per_m(state.high_um),
               known_mm_per_m(state.left_um),
               known_mm_per_m(state.right_um),
               name_of_index(state.centre_only),
               classes.classes[class_index(classes, iri)].name,
               std::int64_t{state.passes},
               std::int64_t{state.vehicles},
               known_day(state.first_seen_ms),
               known_day(state.last_seen_ms),
               known_mm_per_m(state.trend_um_per_year),
               known_mm_per_m(state.trend_sd_um_per_year),
               known_day(changed_ms),
               change,
               name_of_validity(state.validity),
               state.first_seen_ms,
               state.last_seen_ms,
               changed_ms,
               std::int64_t{state.validity});
}

const char* const pass_columns =
    "pass.occurrence, pass.iri_left_um, pass.iri_right_um, pass.iri_centre_um, pass.iri_um,"
    " pass.sd_um, pass.centre_only, pass.validity, pass.speed_mmps, pass.covered_mm,"
    " pass.confidence_ppm, pass.t_ms, pass.drive";

/// Drive number; `std::nullopt` for an invalid one, which matches no trace.
std::optional<std::uint32_t> known_drive_in(const Statement& row, int column) {
    const auto number = row.known_integer(column);
    return number ? std::optional{static_cast<std::uint32_t>(*number)} : std::nullopt;
}

Pass pass_in(const Statement& row, int first, const SegmentKey& segment) {
    return {.segment = segment,
            .occurrence = static_cast<std::uint32_t>(row.integer(first)),
            .iri_left_um = known_whole_in(row, first + 1),
            .iri_right_um = known_whole_in(row, first + 2),
            .iri_centre_um = known_whole_in(row, first + 3),
            .iri_um = static_cast<IriUm>(row.integer(first + 4)),
            .sd_um = static_cast<IriUm>(row.integer(first + 5)),
            .centre_only = row.integer(first + 6) != 0,
            .validity = static_cast<std::uint8_t>(row.integer(first + 7)),
            .speed_mmps = static_cast<std::int32_t>(row.integer(first + 8)),
            .covered_mm = static_cast<std::int32_t>(row.integer(first + 9)),
            .confidence_ppm = static_cast<std::int32_t>(row.integer(first + 10)),
            .t_ms = row.integer(first + 11),
            .drive = known_drive_in(row, first + 12)};
}

SegmentKey key_in(const Statement& row, int first) {
    return {row.integer(first),
            row.blob(first + 1) == "forward",
            static_cast<std::uint32_t>(row.integer(first + 2))};
}

std::optional<std::int64_t> known_utc_ms(const Statement& row, int column) {
    return known_time_in(row, column);
}

std::optional<std::int64_t> utc_ms_of(const std::optional<std::int64_t>& trip_utc_ms,
                                      const Pass& pass) {
    const bool can_be_added = unless_absurd(pass.t_ms).has_value();
    return trip_utc_ms && can_be_added ? unless_absurd(*trip_utc_ms + pass.t_ms) : std::nullopt;
}

const char* name_of_index(bool centre_only) {
    return centre_only ? "HRI>MRI" : "MRI";
}

double mm_per_m(IriUm um) {
    return um / 1000.0;
}

std::string datetime_text(std::int64_t utc_ms) {
    auto text = utc_text(utc_ms);
    return text.find('.') == std::string::npos ? text.insert(text.size() - 1, ".000") : text;
}

} // namespace macadam
