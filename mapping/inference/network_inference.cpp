#include "mapping/inference/network_inference.hpp"

#include "estimator/common/statistics.hpp"
#include "mapping/geometry/local_frame.hpp"
#include "mapping/inference/inferred_network.hpp"
#include "mapping/inference/junctions.hpp"
#include "mapping/inference/refinement.hpp"
#include "mapping/inference/track_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr int rounds = 3; // of drawing; later rounds join ways kept apart by noise in the first
constexpr int refinements = 2;  // per round; the second compares every line with the road's centre
constexpr double beside_m = 60; // lines farther apart drove different roads
constexpr std::size_t max_samples = 5000;    // points compared with all others around them
constexpr double sd_per_median = 1 / 0.6745; // for absolute values of a normal distribution

bool drew_before(const GeoPoint& a, const GeoPoint& b) {
    return std::tie(a.lat_deg, a.lon_deg) < std::tie(b.lat_deg, b.lon_deg);
}

bool is_before(const TripDrawing* a, const TripDrawing* b) {
    if (a->sha256 != b->sha256) {
        return a->sha256 < b->sha256;
    }
    return std::lexicographical_compare(
        a->lines.begin(),
        a->lines.end(),
        b->lines.begin(),
        b->lines.end(),
        [](const auto& x, const auto& y) {
            return std::lexicographical_compare(
                x.points.begin(), x.points.end(), y.points.begin(), y.points.end(), drew_before);
        });
}

/// Sorts trips by content and removes duplicates.
std::vector<const TripDrawing*> in_order(std::span<const TripDrawing> trips) {
    std::vector<const TripDrawing*> ordered;
    for (const auto& trip : trips) {
        ordered.push_back(&trip);
    }
    std::ranges::stable_sort(ordered, is_before);
    const auto is_same = [](const TripDrawing* a, const TripDrawing* b) {
        return !is_before(a, b) && !is_before(b, a);
    };
    ordered.erase(std::unique(ordered.begin(), ordered.end(), is_same), ordered.end());
    return ordered;
}

/// Lines of roads that may meet.
using Region = std::vector<const TripDrawing::Line*>;

/// Groups lines: those in the same or in neighbouring cells of a degree belong to one region. The
/// plane of a region is not distorted by roads on another continent.
class RegionFinder {
public:
    void add(const TripDrawing::Line& line) {
        const auto number = lines_.size();
        lines_.push_back(&line);
        parent_.push_back(number);
        std::optional<Cell> last;
        for (const auto& point : line.points) {
            const Cell cell{std::floor(point.lat_deg), std::floor(point.lon_deg)};
            if (cell != last) {
                visit(cell, number);
                last = cell;
            }
        }
    }

    /// Returns the regions in the order of their first lines.
    std::vector<Region> regions() {
        std::vector<Region> found;
        std::vector<std::size_t> place(lines_.size());
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const auto first = root_of(i);
            if (first == i) {
                place[i] = found.size();
                found.emplace_back();
            }
            found[place[first]].push_back(lines_[i]);
        }
        return found;
    }

private:
    using Cell = std::pair<double, double>; ///< whole degrees of latitude and longitude

    void visit(const Cell& cell, std::size_t line) {
        for (const double north : {-1, 0, 1}) {
            for (const double east : {-1, 0, 1}) {
                const auto found = line_in_.find({cell.first + north, cell.second + east});
                if (found != line_in_.end()) {
                    unite(line, found->second);
                }
            }
        }
        line_in_.emplace(cell, line);
    }

    void unite(std::size_t a, std::size_t b) {
        const auto [first, second] = std::minmax({root_of(a), root_of(b)});
        parent_[second] = first;
    }

    std::size_t root_of(std::size_t line) {
        while (parent_[line] != line) {
            parent_[line] = parent_[parent_[line]];
            line = parent_[line];
        }
        return line;
    }

    std::vector<const TripDrawing::Line*> lines_;
    std::vector<std::size_t> parent_; ///< first line of a region: itself
    std::map<Cell, std::size_t> line_in_;
};

std::vector<Region> regions_of(std::span<const TripDrawing* const> trips) {
    RegionFinder finder;
    for (const auto* const trip : trips) {
        for (const auto& line : trip->lines) {
            finder.add(line);
        }
    }
    return finder.regions();
}

LocalFrame frame_of(const Region& region) {
    GeoBox box;
    for (const auto* const line : region) {
        for (const auto& point : line->points) {
            box = including(box, point);
        }
    }
    return frame_in_middle_of(box);
}

std::vector<TraceLine> lines_of(const Region& region, const LocalFrame& frame) {
    std::vector<TraceLine> lines;
    for (const auto* const line : region) {
        lines.push_back({frame.to_local(line->points), line->sd_m, line->after_turn});
    }
    return lines;
}

/// Raises the sd of the positions of lines to the spread between lines on the same road, where that
/// exceeds the receivers' statement: slow receiver errors only show where two trips drove the same
/// road.
std::vector<TraceLine> with_seen_sd(std::vector<TraceLine> lines, const TraceConfig& config) {
    TraceIndex index{config};
    std::size_t points = 0;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        index.add(lines[line].points, line);
        points += lines[line].points.size();
    }
    const auto every = points / max_samples + 1;
    std::vector<double> apart;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        const auto& own = lines[line].points;
        for (std::size_t i = every / 2; i < own.size(); i += every) {
            for (const auto& join : index.all_alike(own[i], course_rad(own, i), beside_m)) {
                if (join.at.way != line) {
                    apart.push_back(join.away_m);
                }
            }
        }
    }
    if (apart.empty()) {
        return lines;
    }
    const double sd_m = median(std::move(apart)) * sd_per_median / std::numbers::sqrt2;
    for (auto& line : lines) {
        line.sd_m = std::max(line.sd_m, sd_m);
    }
    return lines;
}

double median_sd_m(const std::vector<TraceLine>& lines) {
    std::vector<double> sds;
    for (const auto& line : lines) {
        sds.push_back(line.sd_m);
    }
    return median(std::move(sds));
}

/// Adds the drawing to ways on the globe, with nodes numbered from `last_node` + 1 in the order of
/// the ways.
void add_ways(std::vector<Way>& ways,
              std::int64_t& last_node,
              const InferredNetwork& drawing,
              const LocalFrame& frame) {
    std::vector<std::int64_t> node_ids(drawing.nodes.size(), 0);
    for (const auto& traced : drawing.ways) {
        Way way{static_cast<std::int64_t>(ways.size() + 1), "", "", Oneway::forward, {}, {}};
        for (const auto node : traced.nodes) {
            if (node_ids[node] == 0) {
                node_ids[node] = ++last_node;
            }
            way.node_ids.push_back(node_ids[node]);
            way.line.push_back(frame.to_geo(drawing.nodes[node]));
        }
        ways.push_back(std::move(way));
    }
}

constexpr std::size_t steps = rounds * (1 + refinements) + 1; // of draw_network()

/// \param step  called after each of the steps.
InferredNetwork draw_network(const std::vector<TraceLine>& lines,
                             const TraceConfig& config,
                             const std::function<void()>& step) {
    InferredNetwork drawing;
    for (int round = 0; round < rounds; ++round) {
        drawing = round == 0 ? drawing_of(lines, config)
                             : drawn_again(drawing, median_sd_m(lines), config);
        step();
        for (int i = 0; i < refinements; ++i) {
            drawing = refined(std::move(drawing), lines, config);
            step();
        }
        drawing = without_outliers(drawing, config);
    }
    drawing = joined(std::move(drawing), lines, config);
    step();
    return drawing;
}

} // namespace

TripDrawing trip_drawing(const TripLog& trip, const TraceConfig& config) {
    return {trip.sha256, trace_lines(trip, config)};
}

std::vector<Way> trace_network(std::span<const TripDrawing> trips,
                               const TraceConfig& config,
                               const Progress& progress) {
    const auto ordered = in_order(trips);
    const auto regions = regions_of(ordered);
    std::size_t done = 0;
    const auto step = [&] { progress(++done, steps * regions.size()); };
    std::vector<Way> ways;
    std::int64_t last_node = 0;
    for (const auto& region : regions) {
        const auto frame = frame_of(region);
        const auto lines = with_seen_sd(lines_of(region, frame), config);
        add_ways(ways, last_node, draw_network(lines, config, step), frame);
    }
    return ways;
}

std::vector<Way> trace_network(std::span<const TripLog> trips, const TraceConfig& config) {
    std::vector<TripDrawing> drawings;
    for (const auto& trip : trips) {
        drawings.push_back(trip_drawing(trip, config));
    }
    return trace_network(drawings, config);
}

} // namespace macadam
