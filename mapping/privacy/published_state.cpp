#include "mapping/privacy/published_state.hpp"

#include "mapping/fusion/utc_month.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace macadam {
namespace {

constexpr IriUm value_step_um = 10;
constexpr IriUm sd_step_um = 50;
constexpr std::int32_t min_published = 5;

IriUm rounded(IriUm um) {
    const auto half = um < 0 ? -value_step_um / 2 : value_step_um / 2;
    return (um + half) / value_step_um * value_step_um;
}

std::optional<IriUm> rounded(const std::optional<IriUm>& um) {
    return um ? std::optional{rounded(*um)} : std::nullopt;
}

IriUm rounded_up(IriUm um) {
    const auto rest = um % sd_step_um;
    return rest == 0 ? um : um - rest + (um > 0 ? sd_step_um : 0);
}

std::optional<std::int64_t> month_of(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? std::optional{month_begin_ms(*utc_ms)} : std::nullopt;
}

std::set<std::int64_t> cars_of(std::span<const FusionInput> passes) {
    std::set<std::int64_t> cars;
    for (const auto& pass : passes) {
        cars.insert(pass.vehicle);
    }
    return cars;
}

bool rests_on_many(const RoadChange& change,
                   std::span<const FusionInput> passes,
                   const ReleaseRule& rule) {
    std::set<std::int64_t> before;
    std::set<std::int64_t> after;
    for (const auto& pass : passes) {
        if (pass.utc_ms) {
            (*pass.utc_ms < change.utc_ms ? before : after).insert(pass.vehicle);
        }
    }
    return std::min(min_count(before, rule), min_count(after, rule)) >= rule.min_cars;
}

} // namespace

std::int32_t published_count(std::int32_t count) {
    if (count < min_published) {
        return 0;
    }
    std::int64_t lower = min_published;
    for (std::int64_t ten = 10;; ten *= 10) {
        for (const std::int64_t next : {ten, 2 * ten, 5 * ten}) {
            if (next > count) {
                return static_cast<std::int32_t>(lower);
            }
            lower = next;
        }
    }
}

SegmentState
published(SegmentState state, std::span<const FusionInput> passes, const ReleaseRule& rule) {
    state.iri_um = rounded(state.iri_um);
    state.sd_um = rounded_up(state.sd_um);
    state.low_um = -rounded_up(-state.low_um); // outward, to reveal no more than the sd
    state.high_um = rounded_up(state.high_um);
    state.left_um = rounded(state.left_um);
    state.right_um = rounded(state.right_um);
    state.passes = published_count(state.passes);
    state.vehicles = published_count(min_count(cars_of(passes), rule));
    state.first_seen_ms = month_of(state.first_seen_ms);
    state.last_seen_ms = month_of(state.last_seen_ms);
    state.trend_um_per_year = rounded(state.trend_um_per_year);
    state.trend_sd_um_per_year = state.trend_sd_um_per_year
                                     ? std::optional{rounded_up(*state.trend_sd_um_per_year)}
                                     : std::nullopt;
    if (state.change && !rests_on_many(*state.change, passes, rule)) {
        state.change.reset();
    }
    if (state.change) {
        state.change = RoadChange{month_begin_ms(state.change->utc_ms), rounded(state.change->um)};
    }
    return state;
}

} // namespace macadam
