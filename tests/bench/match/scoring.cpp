#include "scoring.hpp"
#include "mapping/matching/arcs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam::bench {
namespace {

constexpr double earth_radius_m = 6'371'008.8; // IUGG mean

double haversine_m(const GeoPoint& a, const GeoPoint& b) {
    constexpr double rad_per_deg = std::numbers::pi / 180;
    const double north = std::sin((b.lat_deg - a.lat_deg) * rad_per_deg / 2);
    const double east = std::sin((b.lon_deg - a.lon_deg) * rad_per_deg / 2);
    const double h = north * north + std::cos(a.lat_deg * rad_per_deg) *
                                         std::cos(b.lat_deg * rad_per_deg) * east * east;
    return 2 * earth_radius_m * std::asin(std::sqrt(h));
}

/// For each found arc, whether it was driven; one drive serves one arc, the surer first.
std::vector<bool> right_of(std::span<const NodePair> truth, std::span<const FoundArc> found) {
    std::map<NodePair, int> left;
    for (const auto& arc : truth) {
        ++left[arc];
    }
    std::vector<std::size_t> order(found.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return found[a].confidence > found[b].confidence;
    });
    std::vector<bool> right(found.size());
    for (const auto i : order) {
        const auto known = left.find(found[i].nodes);
        right[i] = known != left.end() && known->second-- > 0;
    }
    return right;
}

} // namespace

ArcLengths::ArcLengths(const std::vector<Way>& ways) {
    for (const auto& way : ways) {
        for (std::size_t i = 0; i < way.line.size(); ++i) {
            places_.emplace(way.node_ids[i], way.line[i]);
        }
    }
}

double ArcLengths::operator()(const NodePair& arc) const {
    return haversine_m(places_.at(arc.first), places_.at(arc.second));
}

std::vector<FoundArc> found_arcs(const MatchedTrace& trace, const RoadNetwork& roads) {
    std::vector<FoundArc> found;
    for (const auto& arc : arcs_of(trace, roads)) {
        found.push_back({{arc.from_node, arc.to_node}, arc.confidence});
    }
    return found;
}

Score score_of(std::span<const NodePair> truth,
               std::span<const FoundArc> found,
               const ArcLengths& length_m) {
    Score score;
    for (const auto& arc : truth) {
        score.truth_m += length_m(arc);
    }
    const auto right = right_of(truth, found);
    for (std::size_t i = 0; i < found.size(); ++i) {
        score.matched_m += length_m(found[i].nodes);
        score.common_m += right[i] ? length_m(found[i].nodes) : 0;
    }
    return score;
}

Totals totals_of(std::span<const Score> scores) {
    Score all;
    Totals totals{};
    for (const auto& score : scores) {
        all.truth_m += score.truth_m;
        all.matched_m += score.matched_m;
        all.common_m += score.common_m;
        totals.mcf += score.common_m / std::max(score.truth_m, score.matched_m);
        totals.empty += score.matched_m == 0 ? 1 : 0;
    }
    totals.wcf = all.common_m / std::max(all.truth_m, all.matched_m);
    totals.mcf /= static_cast<double>(scores.size());
    totals.rmf = (all.missed_m() + all.wrong_m()) / all.truth_m;
    return totals;
}

void Calibration::add(std::span<const NodePair> truth,
                      std::span<const FoundArc> found,
                      const ArcLengths& length_m) {
    const auto right = right_of(truth, found);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto at = static_cast<std::size_t>(found[i].confidence * 10);
        auto& bin = bins_[std::min<std::size_t>(at, bins_.size() - 1)];
        const double arc_m = length_m(found[i].nodes);
        bin.length_m += arc_m;
        bin.confidence_m += arc_m * found[i].confidence;
        bin.right_m += right[i] ? arc_m : 0;
        if (found[i].confidence >= sure_from) {
            sure_m_ += arc_m;
            sure_wrong_m_ += right[i] ? 0 : arc_m;
        }
    }
}

double Calibration::expected_error() const {
    double error_m = 0;
    double whole_m = 0;
    for (const auto& bin : bins_) {
        error_m += std::abs(bin.confidence_m - bin.right_m);
        whole_m += bin.length_m;
    }
    return error_m / whole_m;
}

double Calibration::sure_share() const {
    double whole_m = 0;
    for (const auto& bin : bins_) {
        whole_m += bin.length_m;
    }
    return sure_m_ / whole_m;
}

double Calibration::sure_wrong_share() const {
    return sure_wrong_m_ / sure_m_;
}

} // namespace macadam::bench
