#include "mapping/privacy/release_batches.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace macadam {
namespace {

using Months = std::map<std::int64_t, std::vector<std::size_t>>; ///< pending passes by month

constexpr auto undated = std::numeric_limits<std::int64_t>::min();

constexpr std::int64_t day_ms = 86'400'000;
constexpr std::int64_t days_of_era = 146'097; // 400 years

constexpr std::int64_t floored(std::int64_t value, std::int64_t by) {
    return value / by - (value % by < 0 ? 1 : 0);
}

/// Month counted from March of the year 0, so that a leap day ends its year.
///
/// Source: H. Hinnant, "chrono-Compatible Low-Level Date Algorithms" (2013), civil_from_days.
struct Month {
    std::int64_t year;
    std::int64_t number; ///< 0 = March
};

Month month_of(std::int64_t utc_ms) {
    const auto day = floored(utc_ms, day_ms) + 719'468; // since 0000-03-01
    const auto era = floored(day, days_of_era);
    const auto of_era = day - era * days_of_era;
    const auto year = (of_era - of_era / 1460 + of_era / 36'524 - of_era / (days_of_era - 1)) / 365;
    const auto of_year = of_era - (365 * year + year / 4 - year / 100);
    return {year + 400 * era, (5 * of_year + 2) / 153};
}

std::int64_t begin_of(const Month& month) {
    const auto era = floored(month.year, 400);
    const auto year = month.year - 400 * era;
    const auto of_year = (153 * month.number + 2) / 5;
    const auto day = era * days_of_era + 365 * year + year / 4 - year / 100 + of_year - 719'468;
    return day * day_ms;
}

template <typename Condition>
std::int32_t
cars_in(std::span<const PendingPass> passes, const ReleaseRule& rule, Condition is_meant) {
    std::set<std::int64_t> cars;
    for (const auto& pass : passes) {
        if (is_meant(pass)) {
            cars.insert(pass.vehicle);
        }
    }
    return min_count(cars, rule);
}

ReleaseBatch batch_of(const Months& months) {
    ReleaseBatch batch;
    for (const auto& [month, passes] : months) {
        batch.passes.insert(batch.passes.end(), passes.begin(), passes.end());
        if (month != undated) {
            batch.from_ms = batch.from_ms.value_or(month);
            batch.until_ms = next_month_ms(month);
        }
    }
    std::ranges::sort(batch.passes);
    return batch;
}

} // namespace

std::int32_t min_count(const std::set<std::int64_t>& vehicles, const ReleaseRule& rule) {
    std::ptrdiff_t most = 0;
    auto first = vehicles.begin();
    for (const auto last : rule.last_of_key) {
        const auto past = vehicles.upper_bound(last);
        most = std::max(most, std::distance(first, past));
        first = past;
    }
    return static_cast<std::int32_t>(std::max(most, std::distance(first, vehicles.end())));
}

std::int64_t month_begin_ms(std::int64_t utc_ms) {
    return begin_of(month_of(utc_ms));
}

std::int64_t next_month_ms(std::int64_t utc_ms) {
    auto [year, number] = month_of(utc_ms);
    const bool is_february = number == 11;
    return begin_of({is_february ? year + 1 : year, is_february ? 0 : number + 1});
}

Release release(std::span<const PendingPass> pending, const ReleaseRule& rule) {
    Months months;
    for (std::size_t i = 0; i < pending.size(); ++i) {
        const auto& utc_ms = pending[i].utc_ms;
        months[utc_ms ? month_begin_ms(*utc_ms) : undated].push_back(i);
    }
    const bool may_appear =
        cars_in(pending, rule, [](const PendingPass& pass) { return pass.is_new; }) >=
            rule.min_new_cars ||
        cars_in(pending, rule, [](const PendingPass& pass) { return pass.has_aged; }) >=
            rule.min_cars;
    Release result;
    Months together;
    std::set<std::int64_t> cars;
    for (auto& [month, passes] : months) {
        for (const auto i : passes) {
            cars.insert(pending[i].vehicle);
        }
        together.emplace(month, std::move(passes));
        if (may_appear && min_count(cars, rule) >= rule.min_cars) {
            result.batches.push_back(batch_of(together));
            together.clear();
            cars.clear();
        }
    }
    result.left = batch_of(together).passes;
    return result;
}

} // namespace macadam
