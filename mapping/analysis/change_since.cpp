#include "mapping/analysis/change_since.hpp"

#include "estimator/common/statistics.hpp"
#include "mapping/analysis/network_summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;

struct SegmentPair {
    std::size_t before;
    std::size_t after;
};

/// Returns the segments known on both sides and reports the length known on one side only to
/// `alone`.
template <typename Alone>
std::vector<SegmentPair> common_places(std::span<const MeasuredSegment> before,
                                       std::span<const MeasuredSegment> since,
                                       const Alone& alone) {
    std::vector<SegmentPair> places;
    std::size_t i = 0, k = 0;
    while (i < before.size() || k < since.size()) {
        const bool first = k == since.size() || (i < before.size() && before[i].key < since[k].key);
        const bool second = !first && (i == before.size() || since[k].key < before[i].key);
        if (first) {
            alone(before[i++], &ChangeLengths::before_alone_m);
        } else if (second) {
            alone(since[k++], &ChangeLengths::since_alone_m);
        } else {
            places.push_back({i++, k++});
        }
    }
    return places;
}

/// Averages over a section: half of the remaining variance is common to its segments, as in
/// road_mean.
Difference mean_of(std::span<const Difference> pieces) {
    Difference mean;
    double sum = 0, together = 0, apart = 0;
    for (const auto& [length_m, mm_per_m, sd] : pieces) {
        mean.length_m += length_m;
        sum += length_m * mm_per_m;
        together += length_m * sd;
        apart += length_m * sd * length_m * sd;
    }
    if (mean.length_m > 0) {
        mean.mm_per_m = sum / mean.length_m;
        mean.sd = std::sqrt(std::lerp(apart, together * together, common_share_along_road)) /
                  mean.length_m;
    }
    return mean;
}

void add(ChangeLengths& lengths, const ComparedSegment& segment) {
    auto& of = segment.verdict == Verdict::improved       ? lengths.improved_m
               : segment.verdict == Verdict::deteriorated ? lengths.deteriorated_m
                                                          : lengths.unchanged_m;
    of += segment.difference.length_m;
}

bool says_nothing(const ChangeLengths& lengths) {
    return lengths.improved_m + lengths.unchanged_m + lengths.deteriorated_m +
               lengths.before_alone_m + lengths.since_alone_m <=
           0;
}

/// Converts differences to roughness, positive for segments of the given verdict and 0 otherwise,
/// so that worst_sections finds their sections.
std::vector<MeasuredSegment> as_records(std::span<const ComparedSegment> segments,
                                        std::span<const MeasuredSegment> since,
                                        Verdict verdict) {
    std::vector<MeasuredSegment> records;
    records.reserve(segments.size());
    for (const auto& segment : segments) {
        auto record = since[segment.after];
        const double change = std::abs(segment.difference.mm_per_m) * um_per_mm;
        record.iri_um =
            segment.verdict == verdict ? std::max(1, static_cast<IriUm>(std::lround(change))) : 0;
        records.push_back(record);
    }
    return records;
}

ChangedStretch rated(WorstSection stretch,
                     const ChangeSince& change,
                     std::span<const MeasuredSegment> before,
                     std::span<const MeasuredSegment> since) {
    std::vector<RatedLength> first, second;
    std::vector<Difference> differences;
    for (const auto i : stretch.records) {
        const auto& segment = change.segments[i];
        first.push_back(rated_length(before[segment.before]));
        second.push_back(rated_length(since[segment.after]));
        differences.push_back(segment.difference);
    }
    ChangedStretch rated{std::move(stretch), road_mean(first), road_mean(second), {}};
    rated.difference = mean_of(differences);
    rated.low = rated.difference.mm_per_m - normal_interval_90 * rated.difference.sd;
    rated.high = rated.difference.mm_per_m + normal_interval_90 * rated.difference.sd;
    return rated;
}

std::vector<ChangedStretch> stretches_of(const RoadNetwork& roads,
                                         const ChangeSince& change,
                                         std::span<const MeasuredSegment> before,
                                         std::span<const MeasuredSegment> since,
                                         Verdict verdict) {
    const WorstSectionConfig runs{.above_mm_per_m = 0,
                                  .min_length_m = change.config.min_length_m,
                                  .max_unmeasured_m = change.config.max_unmeasured_m,
                                  .most_better_m = change.config.max_other_m,
                                  .sharpest_turn_deg = change.config.sharpest_turn_deg};
    std::vector<ChangedStretch> stretches;
    for (auto& stretch : worst_sections(roads, as_records(change.segments, since, verdict), runs)) {
        auto changed = rated(std::move(stretch), change, before, since);
        if (verdict == Verdict::deteriorated ? changed.low > 0 : changed.high < 0) {
            stretches.push_back(std::move(changed));
        }
    }
    std::ranges::stable_sort(stretches, std::ranges::greater{}, [](const ChangedStretch& changed) {
        return std::abs(changed.difference.mm_per_m);
    });
    return stretches;
}

std::vector<bool> verdicts(std::span<const Difference> differences, double rate) {
    std::vector<double> chances;
    std::ranges::transform(differences, std::back_inserter(chances), chance_of);
    return called(chances, rate);
}

} // namespace

double common_variance(const MeasuredSegment& segment, const FusionConfig& config) {
    if (segment.vehicles == 0) {
        return 0;
    }
    const double level = segment.iri_um / um_per_mm;
    const double sd = segment.sd_um / um_per_mm;
    const double rest = std::hypot(
        config.rest_relative_sd * level, config.trip_relative_sd * level, config.rest_sd_mm_per_m);
    const double of_cars = sd * sd - rest * rest / segment.passes;
    const double stated = of_cars / (config.common_share + config.car_share / segment.vehicles);
    const double common = std::max(0.0, config.common_share * stated);
    if ((segment.validity & validity::lateral_alone) != 0) {
        return common;
    }
    return std::min(common,
                    max_common_variance_um2(segment.iri_um, config) / (um_per_mm * um_per_mm));
}

Difference difference_of(const MeasuredSegment& before,
                         const MeasuredSegment& after,
                         const FusionConfig& config) {
    const auto first = rated_length(before);
    const auto second = rated_length(after);
    const double common1 = common_variance(before, config);
    const double common2 = common_variance(after, config);
    const double apart = first.sd * first.sd - common1 + second.sd * second.sd - common2;
    return {second.length_m,
            second.iri - first.iri,
            std::hypot(std::sqrt(apart), std::sqrt(common1) - std::sqrt(common2))};
}

double chance_of(const Difference& difference) {
    return difference.sd > 0
               ? std::erfc(std::abs(difference.mm_per_m) / difference.sd / std::numbers::sqrt2)
               : 1;
}

std::vector<bool> called(std::span<const double> chances, double rate) {
    std::vector<double> sorted(chances.begin(), chances.end());
    std::ranges::sort(sorted);
    double border = -1;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (sorted[i] <= rate * static_cast<double>(i + 1) / static_cast<double>(sorted.size())) {
            border = sorted[i];
        }
    }
    std::vector<bool> is_called;
    for (const double chance : chances) {
        is_called.push_back(chance <= border);
    }
    return is_called;
}

ChangeSince change_since(const RoadNetwork& roads,
                         std::span<const MeasuredSegment> before,
                         std::span<const MeasuredSegment> since,
                         const ChangeSinceConfig& config,
                         const AloneLengths& alone) {
    ChangeSince change;
    change.config = config;
    for (const auto kind : road_kinds()) {
        change.kinds.emplace_back().kind = kind;
    }
    const auto of_kind = [&](std::string_view highway) -> ChangeLengths& {
        return *std::ranges::find(change.kinds, road_kind(highway), &ChangeLengths::kind);
    };
    const auto add_alone =
        [&](std::string_view highway, double length_m, double ChangeLengths::*alone_m) {
            change.all.*alone_m += length_m;
            of_kind(highway).*alone_m += length_m;
        };
    for (const auto& [highway, length_m] : alone.before_m) {
        add_alone(highway, length_m, &ChangeLengths::before_alone_m);
    }
    for (const auto& [highway, length_m] : alone.since_m) {
        add_alone(highway, length_m, &ChangeLengths::since_alone_m);
    }
    const auto places = common_places(
        before, since, [&](const MeasuredSegment& segment, double ChangeLengths::*alone_m) {
            add_alone(segment.highway, segment.to_m - segment.from_m, alone_m);
        });
    std::vector<Difference> differences;
    for (const auto& [i, k] : places) {
        differences.push_back(difference_of(before[i], since[k], config.fusion));
        change.called_alone +=
            chance_of(differences.back()) < std::erfc(normal_interval_95 / std::numbers::sqrt2) ? 1
                                                                                                : 0;
    }
    const auto is_called = verdicts(differences, config.rate);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto verdict = !is_called[i]                 ? Verdict::no_change_shown
                             : differences[i].mm_per_m > 0 ? Verdict::deteriorated
                                                           : Verdict::improved;
        change.segments.push_back({places[i].before, places[i].after, differences[i], verdict});
        add(change.all, change.segments.back());
        add(of_kind(since[places[i].after].highway), change.segments.back());
    }
    change.all.mean = mean_of(differences);
    for (auto& kind : change.kinds) {
        std::vector<Difference> of_this;
        for (const auto& segment : change.segments) {
            if (road_kind(since[segment.after].highway) == kind.kind) {
                of_this.push_back(segment.difference);
            }
        }
        kind.mean = mean_of(of_this);
    }
    std::erase_if(change.kinds, says_nothing);
    change.worse = stretches_of(roads, change, before, since, Verdict::deteriorated);
    change.better = stretches_of(roads, change, before, since, Verdict::improved);
    return change;
}

} // namespace macadam
