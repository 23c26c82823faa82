#include "mapping/inference/refinement.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double trimmed_share = 0.2; // of the weight, at either end
constexpr double move_sd_points = 2;  // of the kernel that smooths the moves along a way
constexpr std::size_t move_reach = 6; // points; three times the sd
constexpr std::size_t goes_back = 2;  // points of backward noise along a way

// A way of one line within outlier_m of a way of many is a receiver error rather than a road.
constexpr double outlier_m = 40;

/// Lateral offset of a line to the right of a vertex.
struct Offset {
    double m;
    double weight;
};
using Offsets = std::vector<std::vector<std::vector<Offset>>>; ///< per way, per vertex

/// Projection of a line's point onto its way.
struct Projection {
    double station; ///< in vertices from the start of the way
    double right_m;
};

PointEn to_right(const std::vector<PointEn>& line, std::size_t i) {
    const double course = course_rad(line, i);
    return {std::cos(course), -std::sin(course)};
}

Projection projected(const std::vector<PointEn>& way, std::size_t near, const PointEn& at) {
    Projection best{};
    double min_m = std::numeric_limits<double>::infinity();
    const auto first = near - std::min<std::size_t>(near, 1);
    const auto last = std::min(near + 1, way.size() - 1);
    for (auto i = first; i < last; ++i) {
        const double east_m = way[i + 1].east_m - way[i].east_m;
        const double north_m = way[i + 1].north_m - way[i].north_m;
        const double long_m = std::hypot(east_m, north_m);
        if (!(long_m > 0)) {
            continue;
        }
        const double de_m = at.east_m - way[i].east_m;
        const double dn_m = at.north_m - way[i].north_m;
        const double share = (de_m * east_m + dn_m * north_m) / (long_m * long_m);
        const double held = std::clamp(share, 0.0, 1.0);
        const double away_m = std::hypot(de_m - held * east_m, dn_m - held * north_m);
        if (away_m < min_m) {
            min_m = away_m;
            best = {static_cast<double>(i) + share, (de_m * north_m - dn_m * east_m) / long_m};
        }
    }
    return best;
}

/// Adds the offsets of one run along a way to the vertices passed.
void add_drive(std::vector<std::vector<Offset>>& offsets,
               const std::vector<Projection>& drive,
               double weight) {
    for (std::size_t k = 1; k < drive.size(); ++k) {
        const auto& a = drive[k - 1];
        const auto& b = drive[k];
        const double first = std::max(0.0, std::ceil(a.station));
        for (double v = first; v < b.station && v < static_cast<double>(offsets.size()); ++v) {
            const double share = (v - a.station) / (b.station - a.station);
            offsets[static_cast<std::size_t>(v)].push_back(
                {std::lerp(a.right_m, b.right_m, share), weight});
        }
    }
}

void add_line(Offsets& offsets,
              const std::vector<std::vector<PointEn>>& ways,
              const TraceLine& line,
              const TraceJoins& joins) {
    const double weight = 1 / (line.sd_m * line.sd_m);
    std::vector<Projection> drive;
    std::optional<TraceVertex> last;
    const auto flush = [&] {
        if (last && drive.size() > 1) {
            add_drive(offsets[last->way], drive, weight);
        }
        drive.clear();
    };
    for (std::size_t i = 0; i < joins.size(); ++i) {
        const bool goes_on = joins[i] && last && last->way == joins[i]->at.way &&
                             joins[i]->at.point + goes_back >= last->point;
        if (!goes_on) {
            flush();
        }
        last = joins[i] ? std::optional{joins[i]->at} : std::nullopt;
        if (last) {
            const auto here = projected(ways[last->way], last->point, line.points[i]);
            if (drive.empty() || here.station > drive.back().station) {
                drive.push_back(here);
            }
        }
    }
    flush();
}

double trimmed_mean(std::vector<Offset>& offsets) {
    std::ranges::sort(offsets, {}, &Offset::m);
    double whole = 0;
    for (const auto& offset : offsets) {
        whole += offset.weight;
    }
    const double low = trimmed_share * whole;
    const double high = whole - low;
    double gone = 0;
    double sum = 0;
    for (const auto& offset : offsets) {
        const double from = std::max(gone, low);
        gone += offset.weight;
        sum += std::max(0.0, std::min(gone, high) - from) * offset.m;
    }
    return sum / (high - low);
}

/// Smooths the moves to the right along the way; vertices without lines follow their neighbours.
std::vector<double> smoothed_moves(const std::vector<std::optional<double>>& moves) {
    std::vector<double> smooth(moves.size(), 0);
    for (std::size_t i = 0; i < moves.size(); ++i) {
        double weight = 0;
        double sum = 0;
        const auto end = std::min(moves.size(), i + move_reach + 1);
        for (auto k = i - std::min(i, move_reach); k < end; ++k) {
            if (moves[k]) {
                const double x = (static_cast<double>(k) - static_cast<double>(i)) / move_sd_points;
                weight += std::exp(-x * x / 2);
                sum += std::exp(-x * x / 2) * *moves[k];
            }
        }
        smooth[i] = weight > 0 ? sum / weight : 0;
    }
    return smooth;
}

std::size_t median_count(const std::vector<std::vector<Offset>>& offsets) {
    std::vector<std::size_t> counts;
    counts.reserve(offsets.size());
    for (const auto& at_vertex : offsets) {
        counts.push_back(at_vertex.size());
    }
    return std::max<std::size_t>(1, median(std::move(counts)));
}

Offsets offsets_of(const std::vector<std::vector<PointEn>>& ways,
                   const std::vector<TraceLine>& lines,
                   const TraceConfig& config) {
    TraceIndex index{config};
    Offsets offsets;
    for (std::size_t way = 0; way < ways.size(); ++way) {
        index.add(ways[way], way);
        offsets.emplace_back(ways[way].size());
    }
    for (const auto& line : lines) {
        add_line(offsets, ways, line, joins_of(line, index, config));
    }
    return offsets;
}

} // namespace

InferredNetwork
refined(InferredNetwork drawing, const std::vector<TraceLine>& lines, const TraceConfig& config) {
    std::vector<std::vector<PointEn>> ways;
    for (std::size_t way = 0; way < drawing.ways.size(); ++way) {
        ways.push_back(points_of(drawing, way));
    }
    auto offsets = offsets_of(ways, lines, config);
    std::vector<bool> moved(drawing.nodes.size(), false);
    for (std::size_t way = 0; way < ways.size(); ++way) {
        auto& traced = drawing.ways[way];
        traced.passes = median_count(offsets[way]);
        std::vector<std::optional<double>> moves;
        for (auto& at_vertex : offsets[way]) {
            moves.push_back(at_vertex.empty() ? std::nullopt
                                              : std::optional{trimmed_mean(at_vertex)});
        }
        const auto smooth = smoothed_moves(moves);
        for (std::size_t i = 0; i < smooth.size(); ++i) {
            const bool is_others =
                (i == 0 && traced.attached_from) || (i + 1 == smooth.size() && traced.attached_to);
            const auto node = traced.nodes[i];
            if (!is_others && !moved[node]) {
                const auto right = to_right(ways[way], i);
                drawing.nodes[node].east_m += smooth[i] * right.east_m;
                drawing.nodes[node].north_m += smooth[i] * right.north_m;
                moved[node] = true;
            }
        }
    }
    return drawing;
}

InferredNetwork without_outliers(const InferredNetwork& drawing, const TraceConfig& config) {
    TraceIndex index{config};
    for (std::size_t way = 0; way < drawing.ways.size(); ++way) {
        if (drawing.ways[way].passes >= many_passes) {
            index.add(points_of(drawing, way), way);
        }
    }
    // Where positions jump aside and back, a line deviates from the road's course for a few points.
    const auto is_outlier = [&](std::size_t way) {
        const auto points = points_of(drawing, way);
        std::size_t alike = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!index.nearest(points[i], outlier_m)) {
                return false;
            }
            alike += index.alike(points[i], course_rad(points, i), outlier_m) ? 1 : 0;
        }
        return drawing.ways[way].passes == 1 && 2 * alike > points.size();
    };
    InferredNetwork kept{drawing.nodes, {}};
    for (std::size_t way = 0; way < drawing.ways.size(); ++way) {
        if (!is_outlier(way)) {
            kept.ways.push_back(drawing.ways[way]);
        }
    }
    return kept;
}

} // namespace macadam
