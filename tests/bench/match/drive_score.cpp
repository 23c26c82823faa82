#include "drive_score.hpp"

#include "estimator/clocks/gnss_latency.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/mounting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace macadam::bench {
namespace {

constexpr double step_m = 1;  // of the truth that is looked at
constexpr double far_m = 100; // another edge of the route so far away is no error of place

struct TimeRange {
    double from_s;
    double to_s;
};

/// When the car was where its positions were taken: the stamps are later.
TimeRange recorded_time(const Recording& recording) {
    const auto& fixes = recording.trip.fixes;
    return {fixes.front().t_s - recording.latency_s, fixes.back().t_s - recording.latency_s};
}

std::vector<TimeRange> outages_of(const Recording& recording, double outage_s) {
    std::vector<TimeRange> outages;
    const auto& fixes = recording.trip.fixes;
    for (std::size_t i = 1; i < fixes.size(); ++i) {
        if (fixes[i].t_s - fixes[i - 1].t_s >= outage_s) {
            outages.push_back(
                {fixes[i - 1].t_s - recording.latency_s, fixes[i].t_s - recording.latency_s});
        }
    }
    return outages;
}

bool is_in(std::span<const TimeRange> ranges, double t_s) {
    return std::ranges::any_of(
        ranges, [&](const TimeRange& range) { return range.from_s < t_s && t_s < range.to_s; });
}

/// Where on the true route a place of the map lies: an edge that is driven twice, where it is
/// nearest to the truth.
class RoutePlaces {
public:
    explicit RoutePlaces(const Drive& drive) : drive_{drive} {
        for (std::size_t i = 0; i < drive.route.size(); ++i) {
            at_[static_cast<std::uint32_t>(drive.route[i])].push_back(i);
        }
    }

    /// Place less truth, 0 within it; nothing if the edge is none of the route's.
    std::optional<double> error_m(EdgeId edge, double offset_m, const TruePlace& truth) const {
        const auto found = at_.find(static_cast<std::uint32_t>(edge));
        if (found == at_.end()) {
            return {};
        }
        double best_m = std::numeric_limits<double>::infinity();
        for (const auto i : found->second) {
            const double place_m = drive_.start_m[i] + offset_m;
            const double error_m = place_m - std::clamp(place_m, truth.from_m, truth.to_m);
            best_m = std::abs(error_m) < std::abs(best_m) ? error_m : best_m;
        }
        return best_m;
    }

private:
    const Drive& drive_;
    std::unordered_map<std::uint32_t, std::vector<std::size_t>> at_;
};

/// The piece that holds a travel, going on from the one that held the travel before.
const MatchedInterval* piece_at(const MatchedTrace& trace, std::size_t& last, double travel_m) {
    while (last + 1 < trace.size() && trace[last].to_travel_m < travel_m) {
        ++last;
    }
    const bool inside = last < trace.size() && trace[last].from_travel_m <= travel_m &&
                        travel_m <= trace[last].to_travel_m;
    return inside ? &trace[last] : nullptr;
}

double offset_m_at(const MatchedInterval& piece, double travel_m) {
    const double whole_m = piece.to_travel_m - piece.from_travel_m;
    const double share = whole_m > 0 ? (travel_m - piece.from_travel_m) / whole_m : 0;
    return std::lerp(piece.from_offset_m, piece.to_offset_m, share);
}

void add_confidence(DriveScore& score, double confidence, bool right) {
    auto& bin = score.confidence[std::min(static_cast<std::size_t>(10 * confidence),
                                          score.confidence.size() - 1)];
    bin.length_m += step_m;
    bin.right_m += right ? step_m : 0;
    bin.confidence_m += confidence * step_m;
    if (confidence >= DriveScore::sure) {
        score.sure_m += step_m;
        score.sure_wrong_m += right ? 0 : step_m;
    }
}

void add_fault(DriveScore& score, double route_m, const char* what) {
    constexpr double joined_m = 2 * step_m;
    if (!score.faults.empty() && score.faults.back().what == std::string_view{what} &&
        route_m - score.faults.back().to_m < joined_m) {
        score.faults.back().to_m = route_m;
        return;
    }
    score.faults.push_back({route_m, route_m, what});
}

} // namespace

Matched matched(TripLog trip, const RoadNetwork& roads, const MatchConfig& config) {
    const auto heading_of = [&](const Odometer& odometer) {
        return make_heading(trip, odometer, estimate_mounting(trip, odometer));
    };
    std::optional<double> latency_s = trip.meta.gnss_latency_s;
    if (!trip.meta.gnss_latency_stated) {
        const auto found = find_gnss_latency(trip, heading_of(make_odometer(trip, {}).odometer));
        latency_s.reset();
        if (found) {
            latency_s = found->latency_s;
        }
        trip.meta.gnss_latency_s = latency_s.value_or(0);
        trip.meta.gnss_latency_sd_s = found ? found->sd_s : 0;
    }
    auto odometer = make_odometer(trip, {}).odometer;
    auto trace = map_match(trip, odometer, roads, config, heading_of(odometer)).trace;
    return {latency_s, std::move(odometer), std::move(trace)};
}

DriveScore score_of(const Drive& drive,
                    const Recording& recording,
                    const Matched& matched,
                    const ScoreRule& rule) {
    DriveScore score;
    score.drives = 1;
    score.positions = recording.trip.fixes.size();
    const auto is_road = [](const MatchedInterval& piece) {
        return piece.kind == IntervalKind::road;
    };
    const auto is_gap = [](const MatchedInterval& piece) {
        return piece.kind == IntervalKind::gap && piece.to_travel_m - piece.from_travel_m >= step_m;
    };
    score.empty = std::ranges::none_of(matched.trace, is_road) ? 1 : 0;
    score.gaps = static_cast<std::size_t>(std::ranges::count_if(matched.trace, is_gap));
    if (matched.latency_s) {
        score.latency_error_s.push_back(
            static_cast<float>(*matched.latency_s - recording.latency_s));
    }
    score.route = route_score_of(drive, recording, driven_edges(matched.trace));
    const auto [from_s, to_s] = recorded_time(recording);
    const auto outages = outages_of(recording, rule.outage_s);
    const RoutePlaces places{drive};
    const double end_m = route_m_at(drive, to_s);
    std::size_t piece_index = 0;
    std::size_t edge = 0;
    for (double route_m = route_m_at(drive, from_s) + step_m / 2; route_m < end_m;
         route_m += step_m) {
        while (drive.start_m[edge + 1] < route_m) {
            ++edge;
        }
        const double t_s = t_s_at(drive, route_m);
        const double travel_m = matched.odometer.travel_m(t_s);
        const bool outage = is_in(outages, t_s);
        score.length_m += step_m;
        score.outage_m += outage ? step_m : 0;
        const auto* const piece = piece_at(matched.trace, piece_index, travel_m);
        if (piece == nullptr || piece->kind != IntervalKind::road) {
            const bool off = piece != nullptr && piece->kind == IntervalKind::off_network;
            (off ? score.off_network_m : score.gap_m) += step_m;
            add_fault(score, route_m, off ? "off the network" : "gap");
            continue;
        }
        const auto error_m =
            places.error_m(piece->edge, offset_m_at(*piece, travel_m), true_place_at(drive, t_s));
        const bool same = piece->edge == drive.route[edge];
        const bool right = same || (error_m && std::abs(*error_m) <= rule.junction_m);
        score.same_edge_m += same ? step_m : 0;
        score.right_m += right ? step_m : 0;
        score.wrong_m += right ? 0 : step_m;
        if (!right) {
            add_fault(score, route_m, error_m ? "far along" : "another road");
        }
        score.outage_right_m += right && outage ? step_m : 0;
        add_confidence(score, piece->confidence, right);
        if (error_m && (same || std::abs(*error_m) <= far_m)) {
            (outage ? score.outage_error_m : score.error_m).push_back(static_cast<float>(*error_m));
        }
    }
    return score;
}

RouteScore route_score_of(const Drive& drive,
                          const Recording& recording,
                          std::span<const DrivenEdge> matched) {
    const auto [from_s, to_s] = recorded_time(recording);
    const double from_m = route_m_at(drive, from_s);
    const double to_m = route_m_at(drive, to_s);
    struct Lengths {
        double truth_m = 0;
        double matched_m = 0;
    };
    std::unordered_map<std::uint32_t, Lengths> of;
    for (std::size_t i = 0; i < drive.route.size(); ++i) {
        of[static_cast<std::uint32_t>(drive.route[i])].truth_m += std::max(
            0.0, std::min(to_m, drive.start_m[i + 1]) - std::max(from_m, drive.start_m[i]));
    }
    for (const auto& part : matched) {
        of[static_cast<std::uint32_t>(part.edge)].matched_m += part.to_m - part.from_m;
    }
    RouteScore score;
    for (const auto& [edge, lengths] : of) {
        score.truth_m += lengths.truth_m;
        score.matched_m += lengths.matched_m;
        score.common_m += std::min(lengths.truth_m, lengths.matched_m);
    }
    return score;
}

std::vector<DrivenEdge> driven_edges(const MatchedTrace& trace) {
    std::vector<DrivenEdge> edges;
    for (const auto& piece : trace) {
        if (piece.kind == IntervalKind::road) {
            edges.push_back({piece.edge, piece.from_offset_m, piece.to_offset_m});
        }
    }
    return edges;
}

RouteScore together(const RouteScore& a, const RouteScore& b) {
    return {a.truth_m + b.truth_m, a.matched_m + b.matched_m, a.common_m + b.common_m};
}

DriveScore together(DriveScore sum, const DriveScore& one) {
    sum.drives += one.drives;
    sum.empty += one.empty;
    sum.gaps += one.gaps;
    sum.positions += one.positions;
    sum.route = together(sum.route, one.route);
    for (double DriveScore::*const part : {&DriveScore::length_m,
                                           &DriveScore::right_m,
                                           &DriveScore::same_edge_m,
                                           &DriveScore::wrong_m,
                                           &DriveScore::off_network_m,
                                           &DriveScore::gap_m,
                                           &DriveScore::outage_m,
                                           &DriveScore::outage_right_m,
                                           &DriveScore::sure_m,
                                           &DriveScore::sure_wrong_m}) {
        sum.*part += one.*part;
    }
    for (std::size_t i = 0; i < sum.confidence.size(); ++i) {
        sum.confidence[i].length_m += one.confidence[i].length_m;
        sum.confidence[i].right_m += one.confidence[i].right_m;
        sum.confidence[i].confidence_m += one.confidence[i].confidence_m;
    }
    for (std::vector<float> DriveScore::*const part :
         {&DriveScore::error_m, &DriveScore::outage_error_m, &DriveScore::latency_error_s}) {
        (sum.*part).insert((sum.*part).end(), (one.*part).begin(), (one.*part).end());
    }
    return sum;
}

double calibration_error(const DriveScore& score) {
    double length_m = 0;
    double off_m = 0;
    for (const auto& bin : score.confidence) {
        length_m += bin.length_m;
        off_m += std::abs(bin.right_m - bin.confidence_m);
    }
    return length_m > 0 ? off_m / length_m : 0;
}

double quantile(std::vector<float> values, double share) {
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, values.begin() + at);
    return values[static_cast<std::size_t>(at)];
}

double absolute_quantile(std::vector<float> values, double share) {
    for (auto& value : values) {
        value = std::abs(value);
    }
    return quantile(std::move(values), share);
}

} // namespace macadam::bench
