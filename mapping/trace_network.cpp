#include "mapping/trace_network.hpp"

#include "mapping/local_frame.hpp"
#include "mapping/trace_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace macadam {
namespace {

constexpr std::size_t least_alike = 3;  // points in a row: fewer only cross the other road
constexpr std::size_t least_delay = 10; // points, until a line may join what it drew itself

/// A point of a way that is drawn, or of the line that is being drawn.
struct Vertex {
    std::size_t way; ///< or own_line
    std::size_t point;
};
constexpr std::size_t own_line = std::numeric_limits<std::size_t>::max();

/// A way while it is drawn, in the plane.
struct DrawnWay {
    std::vector<std::int64_t> node_ids;
    std::vector<PointEn> line;
};

double course_rad(const std::vector<PointEn>& line, std::size_t i) {
    const auto& a = line[i == 0 ? 0 : i - 1];
    const auto& b = line[std::min(i + 1, line.size() - 1)];
    return std::atan2(b.east_m - a.east_m, b.north_m - a.north_m);
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

/// Draws line after line and remembers where roads already are.
class Drawing {
public:
    explicit Drawing(const TraceConfig& config)
        : config_{config}, cell_m_{2 * config.joins_m + config.spacing_m} {}

    void draw(const TraceLine& line) {
        own_ = line;
        own_index_.clear();
        own_place_.assign(line.size(), std::nullopt);
        const auto joins = joins_of(line);
        std::size_t i = 0;
        while (i < line.size()) {
            auto end = i;
            while (end < line.size() && !joins[end]) {
                ++end;
            }
            if (i < end) {
                add_way(line,
                        i,
                        end,
                        i > 0 ? own_place_[i - 1] : std::nullopt,
                        end < line.size() ? place_of(*joins[end]) : std::nullopt);
            }
            for (i = end; i < line.size() && joins[i]; ++i) {
                own_place_[i] = place_of(*joins[i]);
            }
        }
    }

    const std::vector<DrawnWay>& ways() const { return ways_; }

private:
    using Joins = std::vector<std::optional<Vertex>>;

    /// For each point of the line, the point of a drawn way along which it runs.
    Joins joins_of(const TraceLine& line) {
        Joins joins(line.size());
        const auto way_m = std::max(config_.least_way_m, 2 * config_.joins_m);
        const auto delay =
            std::max(least_delay, static_cast<std::size_t>(2 * way_m / config_.spacing_m));
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (i >= delay && !joins[i - delay]) {
                remember(own_index_, line[i - delay], {own_line, i - delay});
            }
            joins[i] = alike(line[i], course_rad(line, i));
        }
        drop_short_runs(joins);
        return joins;
    }

    /// Where the vertex stands in the drawing; nothing if it was left out.
    std::optional<Vertex> place_of(const Vertex& vertex) const {
        return vertex.way == own_line ? own_place_[vertex.point] : vertex;
    }

    const std::vector<PointEn>& line_at(const Vertex& vertex) const {
        return vertex.way == own_line ? own_ : ways_[vertex.way].line;
    }

    /// Running alike for a point or two is a crossing; and so short a way between is noise.
    void drop_short_runs(Joins& joins) const {
        for_each_run(joins, [&](std::size_t first, std::size_t end) {
            if (joins[first] && end - first < least_alike) {
                std::fill(at(joins, first), at(joins, end), std::nullopt);
            }
        });
        for_each_run(joins, [&](std::size_t first, std::size_t end) {
            const bool between = first > 0 && end < joins.size();
            const double long_m = static_cast<double>(end - first) * config_.spacing_m;
            if (!joins[first] && between && long_m < config_.least_way_m &&
                joins[first - 1]->way == joins[end]->way) {
                std::fill(at(joins, first), at(joins, end), joins[first - 1]);
            }
        });
    }

    static Joins::iterator at(Joins& joins, std::size_t i) {
        return joins.begin() + static_cast<std::ptrdiff_t>(i);
    }

    template <typename Visit>
    static void for_each_run(const Joins& joins, Visit visit) {
        for (std::size_t first = 0; first < joins.size();) {
            auto end = first + 1;
            while (end < joins.size() && joins[end].has_value() == joins[first].has_value()) {
                ++end;
            }
            visit(first, end);
            first = end;
        }
    }

    std::optional<Vertex> alike(const PointEn& place, double course) const {
        std::optional<Vertex> best;
        double least_m = config_.joins_m;
        const auto column = cell(place.east_m);
        const auto row = cell(place.north_m);
        for (auto c = column - 1; c <= column + 1; ++c) {
            for (auto r = row - 1; r <= row + 1; ++r) {
                for (const auto* index : {&index_, &own_index_}) {
                    const auto found = index->find(key(c, r));
                    for (std::size_t i = 0; found != index->end() && i < found->second.size();
                         ++i) {
                        const double away_m = away(found->second[i], place, course);
                        if (away_m < least_m) {
                            least_m = away_m;
                            best = found->second[i];
                        }
                    }
                }
            }
        }
        return best;
    }

    /// Infinite where the way there runs otherwise.
    double away(const Vertex& vertex, const PointEn& place, double course) const {
        const auto& line = line_at(vertex);
        const double turned =
            std::remainder(course_rad(line, vertex.point) - course, 2 * std::numbers::pi);
        if (std::abs(turned) > config_.joins_deg * std::numbers::pi / 180) {
            return std::numeric_limits<double>::infinity();
        }
        const auto i = vertex.point;
        const auto& before = line[i == 0 ? 0 : i - 1];
        const auto& after = line[std::min(i + 1, line.size() - 1)];
        return std::min(distance_to_step_m(before, line[i], place),
                        distance_to_step_m(line[i], after, place));
    }

    void add_way(const TraceLine& line,
                 std::size_t first,
                 std::size_t end,
                 const std::optional<Vertex>& from,
                 const std::optional<Vertex>& to) {
        if (static_cast<double>(end - first) * config_.spacing_m < config_.least_way_m) {
            return;
        }
        DrawnWay way;
        if (from) {
            add_shared(way, *from);
        }
        for (auto i = first; i < end; ++i) {
            own_place_[i] = {ways_.size(), way.line.size()};
            way.node_ids.push_back(++last_node_);
            way.line.push_back(line[i]);
        }
        if (to) {
            add_shared(way, *to);
        }
        ways_.push_back(std::move(way));
        const auto& drawn = ways_.back().line;
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            remember(index_, drawn[i], {ways_.size() - 1, i});
        }
    }

    void add_shared(DrawnWay& way, const Vertex& vertex) const {
        way.node_ids.push_back(ways_[vertex.way].node_ids[vertex.point]);
        way.line.push_back(ways_[vertex.way].line[vertex.point]);
    }

    using Index = std::unordered_map<std::int64_t, std::vector<Vertex>>; ///< by cell

    void remember(Index& index, const PointEn& place, const Vertex& vertex) const {
        index[key(cell(place.east_m), cell(place.north_m))].push_back(vertex);
    }
    std::int64_t cell(double m) const { return static_cast<std::int64_t>(std::floor(m / cell_m_)); }
    static std::int64_t key(std::int64_t column, std::int64_t row) {
        return column * (std::int64_t{1} << 32) + row;
    }

    TraceConfig config_;
    double cell_m_;
    std::vector<DrawnWay> ways_;
    Index index_;
    TraceLine own_; ///< the line that is being drawn
    Index own_index_;
    Joins own_place_; ///< where each of its points stands in the drawing
    std::int64_t last_node_ = 0;
};

LocalFrame frame_of(std::span<const TripLog> trips) {
    GeoBox box;
    for (const auto& trip : trips) {
        for (const auto& fix : trip.fixes) {
            if (std::isfinite(fix.at.lat_deg) && std::isfinite(fix.at.lon_deg)) {
                box = including(box, fix.at);
            }
        }
    }
    return is_empty(box) ? LocalFrame{{0, 0}}
                         : LocalFrame{between(
                               {box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}, 0.5)};
}

} // namespace

std::vector<Way> trace_network(std::span<const TripLog> trips, const TraceConfig& config) {
    const auto frame = frame_of(trips);
    Drawing drawing{config};
    for (const auto& trip : trips) {
        for (const auto& line : trace_lines(trip, frame, config)) {
            drawing.draw(line);
        }
    }
    std::vector<Way> ways;
    for (const auto& drawn : drawing.ways()) {
        Way way{static_cast<std::int64_t>(ways.size() + 1),
                "",
                "",
                Oneway::forward,
                drawn.node_ids,
                {}};
        for (const auto& point : drawn.line) {
            way.line.push_back(frame.to_geo(point));
        }
        ways.push_back(std::move(way));
    }
    return ways;
}

} // namespace macadam
