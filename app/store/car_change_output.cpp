#include "app/store/car_change_output.hpp"

#include "estimator/common/statistics.hpp"
#include "storage/text/columns.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace macadam {
namespace {

struct ChangeRow {
    std::string since; ///< day
    CarChange change;
    bool level_changed;
    bool scatter_changed;
};

std::vector<ChangeRow> rows_of(std::span<const CarPeriod> periods) {
    std::vector<ChangeRow> rows;
    for (const auto& [from_ms, change, calibration, shared] : periods) {
        if (from_ms && change) {
            rows.push_back(
                {utc_day(*from_ms), *change, change->level_sd > 0, change->scatter != 1});
        }
    }
    return rows;
}

// clang-format off
const Columns<ChangeRow> columns{
    {"since", as::day, [](auto& r) { return r.since; }},
    {"level", as::real(4), [](auto& r) { return known_if(r.level_changed, r.change.level); }},
    {"level_low", as::real(4), [](auto& r) {
         return known_if(r.level_changed, r.change.level - normal_interval_90 * r.change.level_sd); }},
    {"level_high", as::real(4), [](auto& r) {
         return known_if(r.level_changed, r.change.level + normal_interval_90 * r.change.level_sd); }},
    {"scatter_ratio", as::real(3), [](auto& r) {
         return known_if(r.scatter_changed, r.change.scatter); }},
};
// clang-format on

std::string level_text(std::string_view car, const ChangeRow& row) {
    return fmt::format("{} reads {:.0f} % (±{:.0f}) {} since {}: tyres, load or mount?\n",
                       car,
                       100 * std::abs(row.change.level),
                       std::ceil(100 * normal_interval_90 * row.change.level_sd),
                       row.change.level > 0 ? "higher" : "lower",
                       row.since);
}

std::string scatter_text(std::string_view car, const ChangeRow& row) {
    return row.change.scatter > 1
               ? fmt::format("{}: passes scatter {:.1f} times as much since {}: loose mount?\n",
                             car,
                             row.change.scatter,
                             row.since)
               : fmt::format("{}: passes scatter {:.1f} times less since {}\n",
                             car,
                             1 / row.change.scatter,
                             row.since);
}

} // namespace

std::string changes_text(std::string_view car, std::span<const CarPeriod> periods) {
    std::string text;
    for (const auto& row : rows_of(periods)) {
        text += row.level_changed ? level_text(car, row) : "";
        text += row.scatter_changed ? scatter_text(car, row) : "";
    }
    if (periods.empty()) {
        return text;
    }
    const auto& last = periods.back().calibration;
    if (last && last->scatter > 1) {
        text += fmt::format("{}: passes scatter {:.1f} times as much as those of most cars, and "
                            "count less\n",
                            car,
                            last->scatter);
    }
    return text;
}

std::string changes_json(std::span<const CarPeriod> periods) {
    return json_rows(columns, rows_of(periods));
}

} // namespace macadam
