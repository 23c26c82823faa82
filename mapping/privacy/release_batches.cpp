#include "mapping/privacy/release_batches.hpp"

#include "mapping/fusion/utc_month.hpp"

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
