#include "app/query/monthly_history.hpp"

#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

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

// ---------------------------------------------------------------------------------------- text

std::string passes_of(const CorrelatedMean& road) {
    return road.min_passes == road.median_passes
               ? fmt::format("{}", road.min_passes)
               : fmt::format("{}-{:g}", road.min_passes, road.median_passes);
}

std::string table_of(const std::vector<MonthRow>& months) {
    auto table = fmt::format("{:<8} {:>8} {:>9} {:>6} {:>13} {:>6} {:>6} {:>4}\n",
                             "month",
                             "segments",
                             "metres",
                             "IRI",
                             "90 %",
                             "worst",
                             "passes",
                             "cars");
    for (const auto& [month, segments, road] : months) {
        table += fmt::format("{:<8} {:>8} {:>9.0f} {:>6.2f} {:>5.2f} - {:>5.2f} {:>6.2f} {:>6} "
                             "{:>4}\n",
                             month,
                             segments,
                             road.mean.length_m,
                             road.mean.iri,
                             road.mean.low,
                             road.mean.high,
                             road.worst_iri,
                             passes_of(road),
                             road.vehicles);
    }
    return table;
}

std::string csv_of(const std::vector<MonthRow>& months) {
    std::string csv{"month,segments,length_m,iri,iri_sd,iri_low,iri_high,iri_worst,passes_least,"
                    "passes_median,vehicles\n"};
    for (const auto& [month, segments, road] : months) {
        csv += fmt::format("{},{},{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{}\n",
                           month,
                           segments,
                           road.mean.length_m,
                           road.mean.iri,
                           road.mean.sd,
                           road.mean.low,
                           road.mean.high,
                           road.worst_iri,
                           road.min_passes,
                           road.median_passes,
                           road.vehicles);
    }
    return csv;
}

std::string json_of(const std::vector<MonthRow>& months) {
    std::vector<std::string> objects;
    for (const auto& [month, segments, road] : months) {
        JsonObject object;
        object.add("month", month)
            .add("segments", static_cast<std::int64_t>(segments))
            .add("length_m", JsonNumber{road.mean.length_m, 2})
            .add("iri", JsonNumber{road.mean.iri, 3})
            .add("iri_sd", JsonNumber{road.mean.sd, 3})
            .add("iri_low", JsonNumber{road.mean.low, 3})
            .add("iri_high", JsonNumber{road.mean.high, 3})
            .add("iri_worst", JsonNumber{road.worst_iri, 3})
            .add("passes_least", std::int64_t{road.min_passes})
            .add("passes_median", JsonRaw{fmt::format("{}", road.median_passes)})
            .add("vehicles", std::int64_t{road.vehicles});
        objects.push_back(object.text());
    }
    return json_array(objects) + "\n";
}

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

std::string months_text(const std::vector<MonthRow>& months, std::string_view format) {
    return format == "json" ? json_of(months) : format == "csv" ? csv_of(months) : table_of(months);
}

} // namespace macadam
