#include "mapping/privacy/published_event.hpp"

#include "mapping/fusion/utc_month.hpp"
#include "mapping/privacy/published_state.hpp"

#include <cstdint>
#include <set>

namespace macadam {
namespace {

constexpr std::int32_t m_mm = 1000;
constexpr std::int32_t size_step_um = 5000;
constexpr std::int32_t length_step_mm = 500;

template <typename Integer>
Integer rounded(Integer value, Integer step) {
    return (value + step / 2) / step * step;
}

template <typename Integer>
Integer rounded_up(Integer value, Integer step) {
    return (value + step - 1) / step * step;
}

std::optional<std::int64_t> month_of(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? std::optional{month_begin_ms(*utc_ms)} : std::nullopt;
}

} // namespace

std::optional<FusedEvent> published(FusedEvent event, const ReleaseRule& rule) {
    const auto cars = min_count(std::set(event.cars.begin(), event.cars.end()), rule);
    if (cars < rule.min_cars) {
        return std::nullopt;
    }
    event.cars.clear();
    event.at_mm = rounded(event.at_mm, std::int64_t{m_mm});
    event.place_sd_mm = rounded_up(event.place_sd_mm, m_mm);
    event.size_um = rounded(event.size_um, size_step_um);
    event.sd_um = rounded_up(event.sd_um, size_step_um);
    event.length_mm = rounded(event.length_mm, length_step_mm);
    event.passes = published_count(event.passes);
    event.passes_over = published_count(event.passes_over);
    event.vehicles = published_count(cars);
    event.first_seen_ms = month_of(event.first_seen_ms);
    event.last_seen_ms = month_of(event.last_seen_ms);
    return event;
}

} // namespace macadam
