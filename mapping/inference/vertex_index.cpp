#include "mapping/inference/inferred_network.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t min_alike = 3; // points in a row: shorter runs merely cross the other road
constexpr double joins_sds = 3;  // usual distance of a line from its road, in sds of its positions
constexpr double strays_sds = 5; // temporary distance
constexpr double farthest_join_m = 40;
constexpr double farthest_stray_m = 50;

std::int64_t key(std::int64_t column, std::int64_t row) {
    return column * (std::int64_t{1} << 32) + row;
}

double distance_to_step_m(const PointEn& a, const PointEn& b, const PointEn& at) {
    const double east_m = b.east_m - a.east_m;
    const double north_m = b.north_m - a.north_m;
    const double square = east_m * east_m + north_m * north_m;
    const double dot = (at.east_m - a.east_m) * east_m + (at.north_m - a.north_m) * north_m;
    const double share = square > 0 ? std::clamp(dot / square, 0.0, 1.0) : 0;
    return std::hypot(a.east_m + share * east_m - at.east_m,
                      a.north_m + share * north_m - at.north_m);
}

template <typename Visit>
void for_each_run(const TraceJoins& joins, Visit visit) {
    for (std::size_t first = 0; first < joins.size();) {
        auto end = first + 1;
        while (end < joins.size() && joins[end].has_value() == joins[first].has_value()) {
            ++end;
        }
        visit(first, end);
        first = end;
    }
}

TraceJoins::iterator at(TraceJoins& joins, std::size_t i) {
    return joins.begin() + static_cast<std::ptrdiff_t>(i);
}

/// Removes runs so short that they merely cross another road, and closes short breaks within one
/// way.
void drop_short_runs(TraceJoins& joins, const TraceConfig& config) {
    for_each_run(joins, [&](std::size_t first, std::size_t end) {
        if (joins[first] && end - first < min_alike) {
            std::fill(at(joins, first), at(joins, end), std::nullopt);
        }
    });
    for_each_run(joins, [&](std::size_t first, std::size_t end) {
        const bool between = first > 0 && end < joins.size();
        const double long_m = static_cast<double>(end - first) * config.spacing_m;
        if (!joins[first] && between && long_m < config.min_way_m &&
            joins[first - 1]->at.way == joins[end]->at.way) {
            std::fill(at(joins, first), at(joins, end), joins[first - 1]);
        }
    });
}

} // namespace

std::vector<PointEn> points_of(const InferredNetwork& drawing, std::size_t way) {
    std::vector<PointEn> points;
    points.reserve(drawing.ways[way].nodes.size());
    for (const auto node : drawing.ways[way].nodes) {
        points.push_back(drawing.nodes[node]);
    }
    return points;
}

TraceIndex::TraceIndex(const TraceConfig& config)
    : spacing_m_{config.spacing_m}, cell_m_{2 * config.joins_m + config.spacing_m},
      alike_rad_{config.joins_deg * rad_per_deg} {}

std::int64_t TraceIndex::cell(double m) const {
    return static_cast<std::int64_t>(std::floor(m / cell_m_));
}

void TraceIndex::add(const std::vector<PointEn>& line, std::size_t i, const TraceVertex& vertex) {
    cells_[key(cell(line[i].east_m), cell(line[i].north_m))].push_back(
        {line[i == 0 ? 0 : i - 1],
         line[i],
         line[std::min(i + 1, line.size() - 1)],
         course_rad(line, i),
         vertex});
}

void TraceIndex::add(const std::vector<PointEn>& line, std::size_t way) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        add(line, i, {way, i});
    }
}

template <typename Visit>
void TraceIndex::visit_near(const PointEn& place, double within_m, Visit visit) const {
    const double reach_m = within_m + spacing_m_;
    for (auto c = cell(place.east_m - reach_m); c <= cell(place.east_m + reach_m); ++c) {
        for (auto r = cell(place.north_m - reach_m); r <= cell(place.north_m + reach_m); ++r) {
            const auto found = cells_.find(key(c, r));
            if (found == cells_.end()) {
                continue;
            }
            for (const auto& entry : found->second) {
                const double away_m = std::min(distance_to_step_m(entry.before, entry.at, place),
                                               distance_to_step_m(entry.at, entry.after, place));
                if (away_m < within_m) {
                    visit(entry, away_m);
                }
            }
        }
    }
}

bool TraceIndex::is_alike(const Entry& entry, double course_rad) const {
    return std::abs(std::remainder(entry.course_rad - course_rad, 2 * std::numbers::pi)) <=
           alike_rad_;
}

std::optional<TraceJoin>
TraceIndex::alike(const PointEn& place, double course_rad, double within_m) const {
    std::optional<TraceJoin> best;
    double vertex_m = 0; // the nearer of two neighbouring vertices
    visit_near(place, within_m, [&](const Entry& entry, double away_m) {
        const double to_vertex_m = apart_m(entry.at, place);
        if ((!best || std::tie(away_m, to_vertex_m) < std::tie(best->away_m, vertex_m)) &&
            is_alike(entry, course_rad)) {
            best = {entry.vertex, away_m};
            vertex_m = to_vertex_m;
        }
    });
    return best;
}

std::vector<TraceJoin>
TraceIndex::all_alike(const PointEn& place, double course_rad, double within_m) const {
    std::map<std::size_t, TraceJoin> nearest;
    visit_near(place, within_m, [&](const Entry& entry, double away_m) {
        if (is_alike(entry, course_rad)) {
            auto& best = nearest.try_emplace(entry.vertex.way, TraceJoin{entry.vertex, away_m})
                             .first->second;
            best = away_m < best.away_m ? TraceJoin{entry.vertex, away_m} : best;
        }
    });
    std::vector<TraceJoin> all;
    for (const auto& [way, join] : nearest) {
        all.push_back(join);
    }
    return all;
}

std::optional<TraceJoin> TraceIndex::nearest(const PointEn& place, double within_m) const {
    std::optional<TraceJoin> best;
    visit_near(place, within_m, [&](const Entry& entry, double /*away_m*/) {
        const double away_m = apart_m(entry.at, place);
        if (away_m < within_m && (!best || away_m < best->away_m)) {
            best = {entry.vertex, away_m};
        }
    });
    return best;
}

double seeks_m(const TraceLine& line, const TraceConfig& config) {
    return std::clamp(strays_sds * line.sd_m, config.joins_m, farthest_stray_m);
}

TraceJoins true_joins(TraceJoins nearest, const TraceLine& line, const TraceConfig& config) {
    const double within_m = std::clamp(joins_sds * line.sd_m, config.joins_m, farthest_join_m);
    auto joins = nearest;
    for (auto& join : joins) {
        if (join && join->away_m > within_m) {
            join.reset();
        }
    }
    for_each_run(joins, [&](std::size_t first, std::size_t end) {
        const bool comes_back = first > 0 && end < joins.size() && !joins[first];
        if (comes_back && std::all_of(at(nearest, first), at(nearest, end), [](const auto& join) {
                return join.has_value();
            })) {
            std::copy(at(nearest, first), at(nearest, end), at(joins, first));
        }
    });
    drop_short_runs(joins, config);
    return joins;
}

TraceJoins joins_of(const TraceLine& line, const TraceIndex& index, const TraceConfig& config) {
    TraceJoins nearest;
    nearest.reserve(line.points.size());
    const double within_m = seeks_m(line, config);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
        nearest.push_back(index.alike(line.points[i], course_rad(line.points, i), within_m));
    }
    return true_joins(std::move(nearest), line, config);
}

} // namespace macadam
