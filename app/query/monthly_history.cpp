#include "app/query/monthly_history.hpp"

#include "app/cli/row_writer.hpp"
#include "app/query/mean_cells.hpp"
#include "storage/text/utc.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double far_apart_m = 1e6; // between different roads: no local part of errors is shared

std::int64_t begin_ms(const std::string& month) {
    return std::llround(*parse_utc_s(month + "-01T00:00:00Z") * 1000);
}

std::string month_of(std::int64_t utc_ms) {
    return utc_text(utc_ms).substr(0, 7);
}

std::string month_after(const std::string& month) {
    constexpr std::int64_t more_than_a_month_ms = 32LL * 86'400'000;
    return month_of(begin_ms(month) + more_than_a_month_ms);
}

/// Arranges the segments along one axis: neighbours on their way are adjacent.
CorrelatedMean road_of(const std::vector<SegmentRecord>& records) {
    std::vector<MeasuredPiece> pieces;
    double at_m = 0;
    const SegmentKey* last = nullptr;
    for (const auto& [segment, name, highway, state] : records) {
        const double length_m = segment.to_m - segment.from_m;
        const bool goes_on = last != nullptr && last->way_id == segment.key.way_id &&
                             last->forward == segment.key.forward;
        at_m += goes_on ? length_m : far_apart_m;
        last = &segment.key;
        pieces.push_back({length_m, at_m, &*state});
    }
    return measured_road(pieces, {});
}

/// Returns the period from the first pass of any segment to the last; `std::nullopt` if none is
/// dated.
std::optional<Period> period_of(const std::vector<SegmentRecord>& records) {
    std::optional<Period> period;
    for (const auto& record : records) {
        if (const auto& state = record.state;
            state && state->first_seen_ms && state->last_seen_ms) {
            period = period ? Period{std::min(*period->from_ms, *state->first_seen_ms),
                                     std::max(*period->until_ms, *state->last_seen_ms)}
                            : Period{state->first_seen_ms, state->last_seen_ms};
        }
    }
    return period;
}

Period shared_by(const Period& a, const Period& b) {
    return {std::max(a.from_ms, b.from_ms), // `std::nullopt` is less than any time
            a.until_ms && b.until_ms ? std::min(a.until_ms, b.until_ms)
            : a.until_ms             ? a.until_ms
                                     : b.until_ms};
}

// clang-format off
const Columns<MonthRow> columns{
    {"month", as::text, [](auto& r) { return r.month; }, {"month", "{:<8}"}},
    {"segments", as::integer, [](auto& r) { return r.segments; }, {"segments", " {:>8}"}},
    {"length_m", as::metres(2), [](auto& r) { return r.road.mean.length_m; }, {"metres", " {:>9}", 0}},
    {"iri", as::iri(3), [](auto& r) { return r.road.mean.iri; }, {"IRI", " {:>6}", 2}},
    {"", as::numbers_in("mm/m"), [](auto& r) { return interval_text(r.road.mean); }, {"90 %", " {:>13}"}},
    {"iri_sd", as::iri(3), [](auto& r) { return r.road.mean.sd; }},
    {"iri_low", as::iri(3), [](auto& r) { return r.road.mean.low; }},
    {"iri_high", as::iri(3), [](auto& r) { return r.road.mean.high; }},
    {"iri_worst", as::iri(3), [](auto& r) { return r.road.worst_iri; }, {"worst", " {:>6}", 2}},
    {"", as::text, [](auto& r) { return passes_cell(r.road.min_passes, r.road.median_passes); },
     {"passes", " {:>6}"}},
    {"passes_least", as::integer, [](auto& r) { return r.road.min_passes; }},
    {"passes_median", as::shortest, [](auto& r) { return r.road.median_passes; }},
    {"vehicles", as::integer, [](auto& r) { return r.road.vehicles; }, {"cars", " {:>4}"}},
};
// clang-format on

} // namespace

std::vector<MonthRow>
history_by_month(const std::function<std::vector<SegmentRecord>(const Period&)>& found,
                 const Period& whole) {
    std::vector<MonthRow> months;
    const auto seen = period_of(found(whole));
    if (!seen) {
        return months;
    }
    const auto last = month_of(*seen->until_ms);
    for (auto month = month_of(*seen->from_ms); month <= last;) {
        const auto next = month_after(month);
        auto records = found(shared_by(whole, {begin_ms(month), begin_ms(next)}));
        std::erase_if(records, [](const auto& record) { return !record.state; });
        if (!records.empty()) {
            months.push_back({month, records.size(), road_of(records)});
            month = next;
            continue;
        }
        // One wrong date must not cost a query for each month of a century.
        const auto rest = period_of(found(shared_by(whole, {begin_ms(next), std::nullopt})));
        if (!rest) {
            break;
        }
        month = std::max(next, month_of(*rest->from_ms));
    }
    return months;
}

std::string
months_text(const std::vector<MonthRow>& months, std::string_view format, UnitSystem units) {
    return rows_text(in_units(columns, units), months, format);
}

} // namespace macadam
