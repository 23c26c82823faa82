#include "app/render/change_map.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace macadam {
namespace {

/// Verdict on each segment that was measured; `std::nullopt` where it is not comparable.
using Verdicts = std::map<SegmentKey, std::optional<Verdict>>;

/// Segments to compare; `std::nullopt`: all.
using Selected = std::optional<std::set<SegmentKey>>;

std::vector<SegmentRecord> states_in(const StoreReader& store,
                                     SegmentFilter filter,
                                     const Period& period,
                                     const Selected& selected) {
    filter.period = period;
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) {
        if (!selected || selected->contains(record.segment.key)) {
            records.push_back(record);
        }
    });
    return records;
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

Verdicts verdicts_of(const ComparedStates& states) {
    Verdicts verdicts;
    for (const auto* side : {&states.before, &states.since}) {
        for (const auto& record : *side) {
            verdicts.emplace(record.segment.key, std::nullopt);
        }
    }
    for (const auto& compared : states.change.segments) {
        verdicts[states.since[compared.after].segment.key] = compared.verdict;
    }
    return verdicts;
}

std::vector<MapLine>
change_lines(const StoreReader& store, const GeoBox& ground, const Verdicts& verdicts) {
    return map_lines(store, ground, [&](const SegmentRecord& record, MapLine& line) {
        if (const auto found = verdicts.find(record.segment.key); found != verdicts.end()) {
            line.iri_class = static_cast<int>(found->second.value_or(Verdict::no_change_shown));
            line.few_passes = !found->second;
        }
    });
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

ComparedStates compare_since(const StoreReader& store,
                             const RoadNetwork& roads,
                             SegmentFilter filter,
                             std::int64_t since_ms) {
    const auto whole = filter.period.value_or(Period{});
    const auto selected = take_out_minima(store, filter);
    ComparedStates states{.before = states_in(store, filter, {whole.from_ms, since_ms}, selected),
                          .since = states_in(store, filter, {since_ms, whole.until_ms}, selected),
                          .change = {}};
    states.change = change_since(roads, states.before, states.since, {});
    return states;
}

const ClassTable& change_classes() {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    static constexpr std::array classes{IriClass{"smoother", none, false},
                                        IriClass{"not significant", none, false},
                                        IriClass{"rougher", none, false}};
    static const ClassTable table{"change", "Change", classes};
    return table;
}

MapPlan load_change_map(const StoreReader& store, MapRequest request, std::int64_t since_ms) {
    const auto roads = load_or_build_network(store);
    const auto day = utc_day(since_ms);
    set_words(request.style.words, day);
    request.style.classes = &change_classes();
    // ColorBrewer 2.0 by Cynthia A. Brewer, "RdBu" and for dark pages "RdGy": diverging, apart for
    // every sight and in greyscale; the middle is neutral, and never the loudest.
    request.style.own_ramp = request.style.theme == MapStyle::Theme::dark
                                 ? std::vector<std::uint32_t>{0x92c5de, 0x6b6f76, 0xd6604d}
                                 : std::vector<std::uint32_t>{0x4393c3, 0xf7f7f7, 0xb2182b};
    const auto compared = [&](const SegmentFilter& filter) {
        auto states = compare_since(store, roads, filter, since_ms);
        if (states.before.empty() && states.since.empty()) {
            throw InputError{fmt::format("{}: the selection contains no dated measurement, "
                                         "expected at least one",
                                         store.file().string())};
        }
        return states;
    };
    Verdicts verdicts;
    request.subtitle = fmt::format("{}, before {} against since", period_text(store.seen()), day);
    if (!request.filter.box) {
        const auto states = compared(request.filter);
        const auto& all = states.change.all;
        verdicts = verdicts_of(states);
        request.class_km = {
            all.improved_m / 1000, all.unchanged_m / 1000, all.deteriorated_m / 1000};
    }
    return load_map(store, request, [&](const GeoBox& ground) {
        if (request.filter.box) {
            auto filter = request.filter;
            filter.box = ground;
            verdicts = verdicts_of(compared(filter));
        }
        return change_lines(store, ground, verdicts);
    });
}

} // namespace macadam
