#include "mapping/events/event_fusion.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double mm_per_m = 1000;
constexpr std::int64_t ms_per_day = 86'400'000;

// Part of a size that one pass allows for its model (track_events.cpp). It is common to all passes:
// a hole of 0.3 m is known by its area only, whoever drives over it.
constexpr double common_size_part = 0.3;

constexpr double centre_m = 0.1; // step of tried centres: linear where very many passes agree

using Cluster = std::vector<const EventReport*>;
using PassId = std::pair<std::int64_t, std::uint32_t>;

PassId pass_of(const EventReport& report) {
    return {report.trip, report.event.occurrence};
}

bool has_side(WheelTrack track) {
    return track == WheelTrack::left || track == WheelTrack::right;
}

bool may_be_one(WheelTrack a, WheelTrack b) {
    return !has_side(a) || !has_side(b) || a == b;
}

auto order_of(const EventReport& report) {
    const auto& event = report.event;
    return std::tuple{event.kind,
                      report.station_m,
                      event.track,
                      event.size_um,
                      event.sd_um,
                      event.place_sd_mm,
                      event.length_mm,
                      report.utc_ms};
}

double distance_m(const EventReport& a, const EventReport& b) {
    return std::abs(a.station_m - b.station_m);
}

/// Returns the reports of one event around a centre, one for each pass: the nearest.
///
/// \param side  of reports that have one
Cluster cluster_around(const EventReport& centre,
                       WheelTrack side,
                       std::span<const EventReport* const> near) {
    std::map<PassId, const EventReport*> nearest;
    for (const auto* report : near) {
        if (may_be_one(report->event.track, side)) {
            auto& kept = nearest.try_emplace(pass_of(*report), report).first->second;
            kept = distance_m(*report, centre) < distance_m(*kept, centre) ? report : kept;
        }
    }
    Cluster cluster;
    for (const auto& [pass, report] : nearest) {
        cluster.push_back(report);
    }
    return cluster;
}

Cluster larger(Cluster a, Cluster b) {
    return b.size() > a.size() ? std::move(b) : std::move(a);
}

/// Returns the reports within the window of a centre, which is one of them.
std::span<const EventReport* const>
near(const Cluster& reports, std::size_t centre, double window_m) {
    const double at_m = reports[centre]->station_m;
    const auto station = [](const EventReport* report) { return report->station_m; };
    const auto first = std::ranges::lower_bound(reports, at_m - window_m, {}, station);
    const auto past = std::ranges::upper_bound(reports, at_m + window_m, {}, station);
    return {first, past};
}

/// Returns the largest cluster; of equal ones, the first.
///
/// \param reports  of one kind, in order along the way; not empty
Cluster largest_cluster(const Cluster& reports, double window_m) {
    Cluster best;
    std::map<WheelTrack, double> last_m; // centres that were tried
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const auto& centre = *reports[i];
        const auto around = near(reports, i, window_m);
        const auto track = centre.event.track;
        const auto last = last_m.find(track);
        const bool was_tried = last != last_m.end() && centre.station_m - last->second < centre_m;
        if (around.size() <= best.size() || was_tried) {
            continue;
        }
        last_m[track] = centre.station_m;
        if (has_side(track)) {
            best = larger(std::move(best), cluster_around(centre, track, around));
        } else {
            for (const auto side : {WheelTrack::left, WheelTrack::right}) {
                best = larger(std::move(best), cluster_around(centre, side, around));
            }
        }
    }
    return best;
}

/// Cuts reports of one kind into clusters, the largest first.
///
/// \param reports  without a gap of more than the window
std::vector<Cluster> clusters_of(Cluster reports, double window_m) {
    std::vector<Cluster> clusters;
    while (!reports.empty()) {
        clusters.push_back(largest_cluster(reports, window_m));
        const std::set<const EventReport*> used{clusters.back().begin(), clusters.back().end()};
        std::erase_if(reports, [&](const auto* report) { return used.contains(report); });
    }
    return clusters;
}

/// Cuts all reports, in their order, into clusters.
std::vector<Cluster> clusters_of(const std::vector<EventReport>& reports, double window_m) {
    std::vector<Cluster> clusters;
    Cluster group;
    const auto close = [&] {
        std::ranges::move(clusters_of(std::exchange(group, {}), window_m),
                          std::back_inserter(clusters));
    };
    for (const auto& report : reports) {
        if (!group.empty() && (group.back()->event.kind != report.event.kind ||
                               distance_m(*group.back(), report) > window_m)) {
            close();
        }
        group.push_back(&report);
    }
    close();
    return clusters;
}

struct Mean {
    double value;
    double sd;
};

/// Returns the mean by inverse variance. Where the values scatter more than their variances allow,
/// its sd is larger by that (Birge's ratio: R. T. Birge, Phys. Rev. 40, 207, 1932).
template <typename Value, typename Sd>
Mean weighted_mean(const Cluster& cluster, Value value, Sd sd) {
    double weights = 0, sum = 0;
    for (const auto* report : cluster) {
        const double weight = 1 / (sd(*report) * sd(*report));
        weights += weight;
        sum += weight * value(*report);
    }
    const double mean = sum / weights;
    double chi2 = 0;
    for (const auto* report : cluster) {
        const double off = (value(*report) - mean) / sd(*report);
        chi2 += off * off;
    }
    const double freedom = std::max(1.0, static_cast<double>(cluster.size()) - 1);
    return {mean, std::sqrt(std::max(1.0, chi2 / freedom) / weights)};
}

Mean place_of(const Cluster& cluster) {
    return weighted_mean(
        cluster,
        [](const EventReport& report) { return report.station_m; },
        [](const EventReport& report) { return report.event.place_sd_mm / mm_per_m; });
}

/// Returns the mean size, micrometres.
Mean size_of(const Cluster& cluster) {
    const auto own_sd = [](const EventReport& report) {
        const double sd = report.event.sd_um;
        const double common = std::min(common_size_part * report.event.size_um, 0.9 * sd);
        return std::sqrt(sd * sd - common * common);
    };
    auto mean = weighted_mean(
        cluster,
        [](const EventReport& report) { return static_cast<double>(report.event.size_um); },
        own_sd);
    mean.sd = std::hypot(mean.sd, common_size_part * mean.value);
    return mean;
}

/// Returns the track that most reports of a known one have; `both` wins a tie.
WheelTrack track_of(const Cluster& cluster) {
    const auto count = [&](WheelTrack track) {
        return std::ranges::count_if(
            cluster, [&](const auto* report) { return report->event.track == track; });
    };
    auto best = WheelTrack::unknown;
    std::ptrdiff_t most = 0;
    for (const auto track : {WheelTrack::both, WheelTrack::left, WheelTrack::right}) {
        if (const auto reports = count(track); reports > most) {
            best = track;
            most = reports;
        }
    }
    return best;
}

std::int32_t median_length_mm(const Cluster& cluster) {
    std::vector<std::int32_t> lengths;
    std::ranges::transform(cluster, std::back_inserter(lengths), [](const auto* report) {
        return report->event.length_mm;
    });
    return median(std::move(lengths));
}

void set_times_and_cars(FusedEvent& event, const Cluster& cluster) {
    std::set<std::int64_t> cars;
    for (const auto* report : cluster) {
        cars.insert(report->vehicle);
        if (const auto& t_ms = report->utc_ms) {
            event.first_seen_ms = std::min(event.first_seen_ms.value_or(*t_ms), *t_ms);
            event.last_seen_ms = std::max(event.last_seen_ms.value_or(*t_ms), *t_ms);
        }
    }
    event.cars.assign(cars.begin(), cars.end());
    event.vehicles = static_cast<std::int32_t>(cars.size());
}

std::int64_t day_of(std::int64_t utc_ms) {
    return utc_ms - (utc_ms % ms_per_day + ms_per_day) % ms_per_day;
}

/// Counts the passes over a segment from the day of the first report on; passes without a date
/// always count.
std::int32_t passes_since(const SearchedSegment& segment, const FusedEvent& event) {
    return static_cast<std::int32_t>(
        std::ranges::count_if(segment.passes_utc_ms, [&](const auto& utc_ms) {
            return !utc_ms || !event.first_seen_ms || *utc_ms >= day_of(*event.first_seen_ms);
        }));
}

/// Returns the segment at a station, or the nearest; null if there is none.
const SearchedSegment* segment_at(std::span<const SearchedSegment> segments, double station_m) {
    const auto off_m = [&](const SearchedSegment& segment) {
        return std::max(
            {0.0, segment.from_station_m - station_m, station_m - segment.to_station_m});
    };
    const auto nearest = std::ranges::min_element(segments, {}, off_m);
    return nearest == segments.end() ? nullptr : &*nearest;
}

FusedEvent fused(const Cluster& cluster, const SearchedSegment& segment, const Mean& place) {
    const auto size = size_of(cluster);
    const auto [low, high] = std::minmax({segment.from_station_m, segment.to_station_m});
    const double at_m = std::abs(std::clamp(place.value, low, high));
    FusedEvent event{.segment = segment.key,
                     .kind = cluster.front()->event.kind,
                     .track = track_of(cluster),
                     .at_mm = std::llround(mm_per_m * at_m),
                     .place_sd_mm = static_cast<std::int32_t>(std::lround(mm_per_m * place.sd)),
                     .size_um = static_cast<std::int32_t>(std::lround(size.value)),
                     .sd_um = static_cast<std::int32_t>(std::lround(size.sd)),
                     .length_mm = median_length_mm(cluster),
                     .passes = static_cast<std::int32_t>(cluster.size()),
                     .passes_over = 0,
                     .vehicles = 0,
                     .first_seen_ms = {},
                     .last_seen_ms = {}};
    set_times_and_cars(event, cluster);
    // Near the end of a segment some reports may come from passes over the next one.
    event.passes_over = std::max(event.passes, passes_since(segment, event));
    return event;
}

} // namespace

std::vector<FusedEvent> fuse_events(std::vector<EventReport> reports,
                                    std::span<const SearchedSegment> segments,
                                    const EventRule& rule) {
    std::ranges::sort(reports, {}, order_of);
    std::vector<std::pair<double, FusedEvent>> placed;
    for (auto& cluster : clusters_of(reports, rule.window_m)) {
        if (static_cast<std::int32_t>(cluster.size()) < rule.min_passes) {
            continue;
        }
        std::ranges::sort(cluster, {}, [](const auto* report) { return order_of(*report); });
        const auto place = place_of(cluster);
        if (const auto* segment = segment_at(segments, place.value)) {
            auto event = fused(cluster, *segment, place);
            if (event.passes >= rule.min_share * event.passes_over) {
                placed.emplace_back(place.value, std::move(event));
            }
        }
    }
    std::ranges::sort(placed, {}, [](const auto& each) {
        return std::tuple{each.first, each.second.kind, each.second.track};
    });
    std::vector<FusedEvent> events;
    std::ranges::transform(
        placed, std::back_inserter(events), [](auto& each) { return std::move(each.second); });
    return events;
}

} // namespace macadam
