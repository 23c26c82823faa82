#include "app/pipeline/privacy_trim.hpp"

#include "storage/store/privacy/crowd_trim.hpp"
#include "storage/trips/log/trip_meta.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr double rounding_m = 1e-6; // tolerance of cuts at a segment border

double share(double value, double from, double to) {
    return to > from ? (value - from) / (to - from) : 0;
}

/// Returns the part of an interval between two positions of its travel.
MatchedInterval between_travel(const MatchedInterval& piece, double from_m, double to_m) {
    const double first = share(from_m, piece.from_travel_m, piece.to_travel_m);
    const double last = share(to_m, piece.from_travel_m, piece.to_travel_m);
    auto part = piece;
    part.from_travel_m = from_m;
    part.to_travel_m = to_m;
    part.from_offset_m = std::lerp(piece.from_offset_m, piece.to_offset_m, first);
    part.to_offset_m = std::lerp(piece.from_offset_m, piece.to_offset_m, last);
    part.t_enter_s = std::lerp(piece.t_enter_s, piece.t_leave_s, first);
    part.t_leave_s = std::lerp(piece.t_enter_s, piece.t_leave_s, last);
    return part;
}

/// Returns the part of an interval between two offsets along its edge.
MatchedInterval between_offsets(const MatchedInterval& piece, double from_m, double to_m) {
    const auto travel_at = [&](double offset_m) {
        return std::lerp(piece.from_travel_m,
                         piece.to_travel_m,
                         share(offset_m, piece.from_offset_m, piece.to_offset_m));
    };
    return between_travel(piece, travel_at(from_m), travel_at(to_m));
}

double segment_m(const MatchedInterval& piece, const RoadNetwork& roads) {
    const auto link = link_at(roads, piece.edge);
    return (link.to_m - link.from_m) / link.segments;
}

/// Returns the trace from one position of its travel on, without the rest of the segment there.
MatchedTrace cut_before(const MatchedTrace& matched, double from_m, const RoadNetwork& roads) {
    MatchedTrace rest;
    const MatchedInterval* cut = nullptr; // interval with the cut, while its segment lasts
    double border_m = 0;                  // border of that segment, along the edge
    for (const auto& piece : matched) {
        if (piece.to_travel_m <= from_m) {
            continue;
        }
        if (piece.from_travel_m < from_m && piece.kind == IntervalKind::road) {
            const double length_m = segment_m(piece, roads);
            const auto part = between_travel(piece, from_m, piece.to_travel_m);
            cut = &piece;
            border_m = std::ceil(part.from_offset_m / length_m - rounding_m) * length_m;
        }
        const bool goes_on = cut != nullptr && piece.edge == cut->edge &&
                             piece.kind == IntervalKind::road && piece.from_offset_m < border_m;
        if (!goes_on) {
            cut = nullptr;
            rest.push_back(
                between_travel(piece, std::max(from_m, piece.from_travel_m), piece.to_travel_m));
        } else if (piece.to_offset_m > border_m) {
            rest.push_back(between_offsets(piece, border_m, piece.to_offset_m));
            cut = nullptr;
        }
    }
    return rest;
}

/// Reverses a trace as far as cutting needs it: travel and offsets change sign.
MatchedTrace backward(MatchedTrace matched) {
    std::ranges::reverse(matched);
    for (auto& piece : matched) {
        piece.from_travel_m = -std::exchange(piece.to_travel_m, -piece.from_travel_m);
        piece.from_offset_m = -std::exchange(piece.to_offset_m, -piece.from_offset_m);
        std::swap(piece.t_enter_s, piece.t_leave_s);
    }
    return matched;
}

/// Returns the trace within one part of its travel.
MatchedTrace within(const MatchedTrace& matched, const TravelSpan& part, const RoadNetwork& roads) {
    return backward(
        cut_before(backward(cut_before(matched, part.from_m, roads)), -part.to_m, roads));
}

} // namespace

TrimRule trim_in(ImportStore& store, TrimRule asked) {
    if (store.map.settings().privacy != PrivacyProfile::crowd) {
        return asked;
    }
    store.trips->make_missing_key();
    auto rule = crowd_trim(*store.trips->key());
    rule.min_m = std::max(rule.min_m, asked.min_m);
    return rule;
}

TrimRule trim_for(const TripMeta& meta, const TrimRule& rule) {
    return trimmed_before_m(meta) >= rule.min_m ? TrimRule{} : rule;
}

KeptParts kept_of(const TripLog& trip, const Odometer& odometer, const TrimRule& rule) {
    return {kept_parts(trip, odometer, rule), !rule.is_active()};
}

double length_m(const KeptParts& kept) {
    double sum_m = 0;
    for (const auto& part : kept.parts) {
        sum_m += part.to_m - part.from_m;
    }
    return sum_m;
}

MatchedTrace trimmed(const MatchedTrace& matched, const KeptParts& kept, const RoadNetwork& roads) {
    if (kept.is_whole) {
        return matched;
    }
    MatchedTrace all;
    for (const auto& part : kept.parts) {
        std::ranges::move(within(matched, part, roads), std::back_inserter(all));
    }
    return all;
}

SampleUse trimmed_use(SampleUse use,
                      const std::vector<double>& t_s,
                      double latency_s,
                      const Odometer& odometer,
                      const KeptParts& kept) {
    if (kept.is_whole) {
        return use;
    }
    std::vector<std::pair<double, double>> times_s;
    for (const auto& part : kept.parts) {
        times_s.emplace_back(odometer.t_s(part.from_m), odometer.t_s(part.to_m));
    }
    for (std::size_t i = 0; i < use.size(); ++i) {
        const double at_s = t_s[i] - latency_s;
        const auto after =
            std::ranges::upper_bound(times_s, at_s, {}, &std::pair<double, double>::first);
        if (after == times_s.begin() || at_s > std::prev(after)->second) {
            use[i] = code(RowReason::trimmed);
        }
    }
    return use;
}

std::string trim_text(const KeptParts& kept, double whole_m, const TrimRule& rule) {
    if (kept.parts.empty() && rule.hides_places) {
        return fmt::format("is {:.0f} m long, all of it near its ends or stops: no pass", whole_m);
    }
    if (kept.parts.empty()) {
        return fmt::format(
            "is {:.0f} m long, all of it within {:g} m of its ends: no pass", whole_m, rule.min_m);
    }
    if (rule.hides_places) {
        const auto stops = kept.parts.size() - 1;
        return fmt::format("{:.0f} m at its ends{} were removed, for privacy",
                           whole_m - length_m(kept),
                           stops > 0 ? " and stops" : "");
    }
    return fmt::format("the first and last {:g} m were removed", rule.min_m);
}

} // namespace macadam
