#include "mapping/privacy/release_batches.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace macadam {
namespace {

using Months = std::map<std::int64_t, std::vector<std::size_t>>; ///< pending passes by their month

constexpr auto undated = std::numeric_limits<std::int64_t>::min();

std::chrono::year_month month_of(std::int64_t utc_ms) {
    const std::chrono::sys_time time{std::chrono::milliseconds{utc_ms}};
    const std::chrono::year_month_day day{std::chrono::floor<std::chrono::days>(time)};
    return day.year() / day.month();
}

std::int64_t begin_of(const std::chrono::year_month& month) {
    const std::chrono::sys_days first = month / std::chrono::day{1};
    return std::chrono::duration_cast<std::chrono::milliseconds>(first.time_since_epoch()).count();
}

template <typename Condition>
std::int32_t cars_in(std::span<const PendingPass> passes, Condition is_meant) {
    std::set<std::int64_t> cars;
    for (const auto& pass : passes) {
        if (is_meant(pass)) {
            cars.insert(pass.vehicle);
        }
    }
    return static_cast<std::int32_t>(cars.size());
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

std::optional<std::int64_t> first_of(const Months& months) {
    return months.empty() ? std::nullopt : std::optional{months.begin()->first};
}

} // namespace

std::int64_t month_begin_ms(std::int64_t utc_ms) {
    return begin_of(month_of(utc_ms));
}

std::int64_t next_month_ms(std::int64_t utc_ms) {
    return begin_of(month_of(utc_ms) + std::chrono::months{1});
}

Release release(std::span<const PendingPass> pending, const ReleaseRule& rule) {
    Months months;
    for (std::size_t i = 0; i < pending.size(); ++i) {
        const auto& utc_ms = pending[i].utc_ms;
        months[utc_ms ? month_begin_ms(*utc_ms) : undated].push_back(i);
    }
    const bool may_appear =
        cars_in(pending, [](const PendingPass& pass) { return pass.is_new; }) >=
            rule.min_new_cars ||
        cars_in(pending, [](const PendingPass& pass) { return pass.has_aged; }) >= rule.min_cars;
    Release result;
    Months together;
    std::set<std::int64_t> cars;
    for (auto& [month, passes] : months) {
        for (const auto i : passes) {
            cars.insert(pending[i].vehicle);
        }
        together.emplace(month, std::move(passes));
        if (may_appear && std::cmp_greater_equal(cars.size(), rule.min_cars)) {
            result.batches.push_back(batch_of(together));
            together.clear();
            cars.clear();
        }
    }
    result.pending_from_ms = first_of(together);
    return result;
}

} // namespace macadam
