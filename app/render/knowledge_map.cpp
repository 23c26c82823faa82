#include "app/render/knowledge_map.hpp"

#include "app/render/box_visit.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

// ColorBrewer 2.0 by Cynthia A. Brewer, "YlGnBu", 5 classes from the dark end: the darker, the
// better known; no colour of a roughness class.
constexpr std::array<std::uint32_t, 5> dark_is_known{
    0x253494, 0x2c7fb8, 0x41b6c4, 0xa1dab4, 0xffffcc};

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t day_ms = 86'400'000;

// From the best known; the last class has the rest.
constexpr std::array least_passes{30, 10, 4, 2};
constexpr std::array most_days{31, 183, 366, 731};
constexpr std::array most_share{0.1, 0.2, 0.35, 0.6}; // half the 90 % interval, relative to the IRI

constexpr std::array passes_classes{IriClass{"30 passes or more", none, false},
                                    IriClass{"10 – 29", none, false},
                                    IriClass{"4 – 9", none, false},
                                    IriClass{"2 – 3", none, false},
                                    IriClass{"1 pass", none, false}};
constexpr std::array age_classes{IriClass{"up to 1 month", none, false},
                                 IriClass{"up to 6 months", none, false},
                                 IriClass{"up to 1 year", none, false},
                                 IriClass{"up to 2 years", none, false},
                                 IriClass{"older", none, false}};
constexpr std::array confidence_classes{IriClass{"± 10 % or less", none, false},
                                        IriClass{"up to ± 20 %", none, false},
                                        IriClass{"up to ± 35 %", none, false},
                                        IriClass{"up to ± 60 %", none, false},
                                        IriClass{"wider", none, false}};

template <typename Limits>
std::size_t first_within(const Limits& limits, auto is_within) {
    return std::size_t(std::ranges::find_if(limits, is_within) - limits.begin());
}

using Selected = std::map<SegmentKey, std::size_t>;

struct Texts {
    std::string subtitle, title, note;
};

Texts texts_of(Knowledge knowledge, const ObservedPeriod& seen) {
    switch (knowledge) {
    case Knowledge::passes:
        return {"Passes of cars per segment and direction",
                "Coverage",
                "The more passes, the surer the value. On roads drawn as one line, the direction "
                "with fewer passes counts."};
    case Knowledge::age:
        return {"Age of the newest pass per segment and direction",
                seen.last_ms ? "Newest pass before " + utc_day(*seen.last_ms) : "Newest pass",
                "Counted back from the newest pass of all. What is old may have been resurfaced "
                "or have broken up since."};
    case Knowledge::confidence:
        break;
    }
    return {"Width of the 90 % interval of the IRI per segment and direction",
            "Confidence of the IRI",
            "With ± 20 %, an IRI shown as 2.0 lies between 1.6 and 2.4 in nine of ten cases."};
}

} // namespace

std::optional<Knowledge> parse_colour_by(const Arguments& arguments) {
    const auto name = arguments.choice("--colour-by");
    if (name == "roughness") {
        return {};
    }
    for (const auto* const option :
         {"--classes", "--ramp", "--grey-below", "--compare-since", "--units"}) {
        if (arguments.is_given(option)) {
            throw UsageError{fmt::format("--colour-by {} and {} cannot be combined", name, option)};
        }
    }
    return name == "passes" ? Knowledge::passes
           : name == "age"  ? Knowledge::age
                            : Knowledge::confidence;
}

const ClassTable& classes_of(Knowledge knowledge) {
    static const std::array tables{ClassTable{"passes", "Passes", passes_classes},
                                   ClassTable{"age", "Age", age_classes},
                                   ClassTable{"confidence", "Confidence", confidence_classes}};
    return tables.at(std::size_t(knowledge));
}

std::optional<std::size_t>
class_in(Knowledge knowledge, const SegmentState& state, std::optional<std::int64_t> newest_ms) {
    if (knowledge == Knowledge::passes) {
        if (state.passes == 0) {
            return {};
        }
        return first_within(least_passes, [&](int least) { return state.passes >= least; });
    }
    if (knowledge == Knowledge::age) {
        if (!state.last_seen_ms || !newest_ms) {
            return {};
        }
        const auto days = double(*newest_ms - *state.last_seen_ms) / day_ms;
        return first_within(most_days, [&](int most) { return days <= most; });
    }
    const double half_um = (double(state.high_um) - double(state.low_um)) / 2;
    return first_within(most_share, [&](double most) {
        return half_um <= most * std::max(1.0, double(state.iri_um));
    });
}

MapPlan load_knowledge_map(const StoreReader& store, MapRequest request, Knowledge knowledge) {
    const auto& table = classes_of(knowledge);
    const auto seen = store.seen();
    const auto texts = texts_of(knowledge, seen);
    request.subtitle = fmt::format("{}  ·  {}", texts.subtitle, period_text(seen));
    request.style.classes = &table;
    request.style.own_ramp.assign(dark_is_known.begin(), dark_is_known.end());
    request.style.words.title = texts.title;
    request.style.words.note = texts.note;
    request.style.words.few_passes =
        knowledge == Knowledge::age ? "No dated pass" : "References only";
    request.style.min_passes = 1;

    Selected selected;
    const auto take = [&](const SegmentRecord& record) {
        const auto found = class_in(knowledge, *record.state, seen.last_ms);
        selected.emplace(record.segment.key, found.value_or(table.classes.size()));
    };
    if (!request.filter.box) {
        request.class_km.assign(table.classes.size(), 0);
        store.visit(request.filter, [&](const SegmentRecord& record) {
            take(record);
            const auto found = class_in(knowledge, *record.state, seen.last_ms);
            if (found) {
                request.class_km[*found] += (record.segment.to_m - record.segment.from_m) / 1000;
            }
        });
    }
    return load_map(store, request, [&](const GeoBox& ground, double scale) {
        if (request.filter.box) {
            selected.clear();
            visit_box(store, request.filter, ground, take);
        }
        return map_lines(
            store,
            ground,
            [&](const SegmentRecord& record, MapLine& line) {
                if (const auto found = selected.find(record.segment.key); found != selected.end()) {
                    line.few_passes = found->second == table.classes.size();
                    line.iri_class = line.few_passes ? 0 : int(found->second);
                }
            },
            joining_at(scale, store.settings().segment_length_m, table));
    });
}

} // namespace macadam
