#include "app/render/change_map.hpp"

#include "app/render/line_collector.hpp"
#include "estimator/common/error.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace macadam {
namespace {

/// Segments to compare; `std::nullopt`: all.
using Selected = std::optional<std::set<SegmentKey>>;

/// Visits the selected segments with passes in a period.
void visit_period(const StoreReader& store,
                  SegmentFilter filter,
                  const Period& period,
                  const Selected& selected,
                  const std::function<void(const SegmentRecord&)>& take) {
    filter.period = period;
    store.visit(filter, [&](const SegmentRecord& record) {
        if (!selected || selected->contains(record.segment.key)) {
            take(record);
        }
    });
}

/// Removes the minimum numbers of passes and cars from a filter. \returns the segments that have
/// them over the whole period, before and since together.
Selected take_out_minima(const StoreReader& store, SegmentFilter& filter) {
    if (filter.min_passes == 0 && filter.min_vehicles == 0) {
        return std::nullopt;
    }
    std::set<SegmentKey> keys;
    store.visit(filter, [&](const SegmentRecord& record) { keys.insert(record.segment.key); });
    filter.min_passes = 0;
    filter.min_vehicles = 0;
    return keys;
}

/// Segments with passes on both sides of a day, in key order, and what has them on one only.
struct BothSides {
    MeasuredSegments before, since;
    AloneLengths alone;
    std::vector<SegmentVerdict> verdicts; ///< on the latter
};

/// Reads one side after the other, and of each the keys first: a network of a million segments
/// that were all driven once would not fit.
BothSides both_sides(const StoreReader& store,
                     const SegmentFilter& filter,
                     std::int64_t since_ms,
                     const Selected& selected) {
    const auto whole = filter.period.value_or(Period{});
    const Period before{whole.from_ms, since_ms};
    const Period since{since_ms, whole.until_ms};
    BothSides both;
    const auto take_into = [&](MeasuredSegments& side, auto& alone_m, const auto& is_common) {
        return [&, is_common](const SegmentRecord& record) {
            if (is_common(record.segment.key)) {
                side.add(record);
            } else {
                alone_m[record.highway] += record.segment.to_m - record.segment.from_m;
                both.verdicts.push_back({record.segment.key, std::nullopt});
            }
        };
    };
    std::vector<SegmentKey> keys;
    visit_period(store, filter, before, selected, [&](const SegmentRecord& record) {
        keys.push_back(record.segment.key);
    });
    const auto is_before = [&](const SegmentKey& key) {
        return std::ranges::binary_search(keys, key);
    };
    visit_period(
        store, filter, since, selected, take_into(both.since, both.alone.since_m, is_before));
    const auto is_since = [&](const SegmentKey& key) {
        return std::ranges::binary_search(both.since.segments, key, {}, &MeasuredSegment::key);
    };
    visit_period(
        store, filter, before, selected, take_into(both.before, both.alone.before_m, is_since));
    return both;
}

/// Sets the texts of the legend, as far as the user has not.
void set_words(LegendWords& words, const std::string& day) {
    const LegendWords usual;
    const auto set = [](auto& word, const auto& was, std::string text) {
        word = word == was ? std::move(text) : word;
    };
    set(words.title, usual.title, fmt::format("Change of roughness since {}", day));
    set(words.few_passes, usual.few_passes, "Not comparable");
    set(words.unmeasured, usual.unmeasured, "No dated measurement");
    set(words.note,
        usual.note,
        "Rougher or smoother where chance is unlikely to explain the difference; not significant "
        "does not mean unchanged.");
}

} // namespace

ComparedStates
compare_since(const StoreReader& store, SegmentFilter filter, std::int64_t since_ms) {
    const auto selected = take_out_minima(store, filter);
    auto [before, since, alone, verdicts] = both_sides(store, filter, since_ms, selected);
    ComparedStates states;
    states.change =
        change_since(since.segments.empty() ? RoadNetwork{} : load_or_build_network(store),
                     before.segments,
                     since.segments,
                     {},
                     alone);
    states.keys.reserve(states.change.segments.size());
    for (const auto& segment : states.change.segments) {
        const auto& key = since.segments[segment.after].key;
        states.keys.push_back(key);
        verdicts.push_back({key, segment.verdict});
    }
    std::ranges::sort(verdicts, {}, &SegmentVerdict::key);
    states.verdicts = std::move(verdicts);
    return states;
}

std::vector<MapLine> change_lines(const StoreReader& store,
                                  const GeoBox& box,
                                  std::span<const SegmentVerdict> verdicts,
                                  double scale_denominator) {
    return map_lines(
        store,
        box,
        [&](const SegmentRecord& record, MapLine& line) {
            const auto found =
                std::ranges::lower_bound(verdicts, record.segment.key, {}, &SegmentVerdict::key);
            if (found != verdicts.end() && found->key == record.segment.key) {
                line.iri_class =
                    static_cast<int>(found->verdict.value_or(Verdict::no_change_shown));
                line.few_passes = !found->verdict;
            }
        },
        joining_at(scale_denominator, store.settings().segment_length_m, change_classes()));
}

const ClassTable& change_classes() {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    static constexpr std::array classes{IriClass{"smoother", none, false},
                                        IriClass{"not significant", none, false},
                                        IriClass{"rougher", none, false}};
    static const ClassTable table{"change", "Change", classes};
    return table;
}

std::vector<std::uint32_t> change_colours(bool on_dark) {
    // ColorBrewer 2.0 by Cynthia A. Brewer, "RdBu", on dark pages with a grey middle: diverging,
    // apart for every sight and in greyscale; the middle is never the loudest.
    return on_dark ? std::vector<std::uint32_t>{0x92c5de, 0x565a61, 0xd6604d}
                   : std::vector<std::uint32_t>{0x4393c3, 0xf7f7f7, 0xb2182b};
}

MapPlan load_change_map(const StoreReader& store, MapRequest request, std::int64_t since_ms) {
    const auto day = utc_day(since_ms);
    set_words(request.style.words, day);
    request.style.classes = &change_classes();
    const bool on_dark = request.style.theme == MapStyle::Theme::dark;
    request.style.own_ramp = change_colours(on_dark);
    if (on_dark && !request.style.colours.few_passes) {
        request.style.colours.few_passes = 0x26282d; // hollow: apart from the grey middle
    }
    const auto compared = [&](const SegmentFilter& filter) {
        auto states = compare_since(store, filter, since_ms);
        if (states.verdicts.empty()) {
            throw InputError{fmt::format("{}: the selection contains no dated measurement, "
                                         "expected at least one",
                                         store.file().string())};
        }
        return states;
    };
    std::vector<SegmentVerdict> verdicts;
    request.subtitle = fmt::format("{}, before {} against since", period_text(store.seen()), day);
    if (!request.filter.box) {
        auto states = compared(request.filter);
        const auto& all = states.change.all;
        verdicts = std::move(states.verdicts);
        request.class_km = {
            all.improved_m / 1000, all.unchanged_m / 1000, all.deteriorated_m / 1000};
    }
    return load_map(store, request, [&](const GeoBox& ground, double scale) {
        if (request.filter.box) {
            auto filter = request.filter;
            filter.box = ground;
            verdicts = compared(filter).verdicts;
        }
        return change_lines(store, ground, verdicts, scale);
    });
}

} // namespace macadam
