#include "mapping/inference/inferred_network.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t own_line = std::numeric_limits<std::size_t>::max();
constexpr std::size_t min_delay = 10; // points before a line may join its own earlier part

// A branch starts where the line began to leave the road, not where it had left it.
constexpr std::size_t longest_leave = 6; // points
constexpr double on_road_m = 3;

/// Draws line after line and indexes the roads drawn so far.
class NetworkBuilder {
public:
    explicit NetworkBuilder(const TraceConfig& config)
        : config_{config}, index_{config}, own_index_{config} {}

    /// \param attach_from, attach_to  whether an end belongs to another way, whatever that way's
    ///                                course.
    void draw(const TraceLine& line, bool attach_from, bool attach_to) {
        line_ = &line;
        const auto size = line.points.size();
        own_place_.assign(size, std::nullopt);
        const auto joins = joins_of_own_too();
        for (std::size_t i = 0; i < size;) {
            const auto first = i;
            while (i < size && !joins[i]) {
                ++i;
            }
            if (first < i) {
                auto from = first > 0 ? own_place_[first - 1] : std::nullopt;
                auto to = i < size ? place_of(joins[i]->at) : std::nullopt;
                if (first == 0 && attach_from) {
                    from = nearest(line.points.front());
                }
                if (i == size && attach_to) {
                    to = nearest(line.points.back());
                }
                add_way(first, i, from, to);
            }
            for (; i < size && joins[i]; ++i) {
                own_place_[i] = place_of(joins[i]->at);
            }
        }
    }

    InferredNetwork take() { return std::move(drawing_); }

private:
    using MaybeVertex = std::optional<TraceVertex>;

    /// Finds for each point of the line its position on a drawn way or, after a delay, on the line
    /// itself.
    TraceJoins joins_of_own_too() {
        own_index_.clear();
        const auto& points = line_->points;
        TraceJoins joins(points.size());
        const double within_m = seeks_m(*line_, config_);
        const auto way_m = std::max(config_.min_way_m, 2 * within_m);
        const auto delay =
            std::max(min_delay, static_cast<std::size_t>(2 * way_m / config_.spacing_m));
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (i >= delay && !joins[i - delay]) {
                own_index_.add(points, i - delay, {own_line, i - delay});
            }
            const double course = course_rad(points, i);
            joins[i] = index_.alike(points[i], course, within_m);
            if (const auto own = own_index_.alike(points[i], course, within_m);
                own && (!joins[i] || own->away_m < joins[i]->away_m)) {
                joins[i] = own;
            }
        }
        joins = true_joins(std::move(joins), *line_, config_);
        begin_branches_early(joins);
        return joins;
    }

    static void begin_branches_early(TraceJoins& joins) {
        const auto free_while_leaving = [&](auto begin, auto end) {
            for (auto join = begin; join != end; ++join) {
                auto left = join;
                for (std::size_t k = 0; *join == std::nullopt && left != begin &&
                                        k < longest_leave && std::prev(left)->has_value();
                     ++k) {
                    const auto before = std::prev(left);
                    const bool nearer = before != begin && std::prev(before)->has_value() &&
                                        (*std::prev(before))->away_m < (*before)->away_m;
                    if ((*before)->away_m < on_road_m || !nearer) {
                        break;
                    }
                    left = before;
                }
                std::fill(left, join, std::nullopt);
            }
        };
        free_while_leaving(joins.begin(), joins.end());
        free_while_leaving(joins.rbegin(), joins.rend());
    }

    /// Returns the position of the vertex in the drawing, or none if it was omitted.
    MaybeVertex place_of(const TraceVertex& vertex) const {
        return vertex.way == own_line ? own_place_[vertex.point] : vertex;
    }

    MaybeVertex nearest(const PointEn& at) const {
        const auto found = index_.nearest(at, config_.joins_m);
        return found ? MaybeVertex{found->at} : std::nullopt;
    }

    void
    add_way(std::size_t first, std::size_t end, const MaybeVertex& from, const MaybeVertex& to) {
        const auto ends = static_cast<std::size_t>(from.has_value()) + to.has_value();
        if (end - first + ends < 2 ||
            static_cast<double>(end - first) * config_.spacing_m < config_.min_way_m) {
            return;
        }
        InferredWay way{
            .nodes = {}, .attached_from = from.has_value(), .attached_to = to.has_value()};
        if (from) {
            way.nodes.push_back(node_at(*from));
        }
        for (auto i = first; i < end; ++i) {
            own_place_[i] = {drawing_.ways.size(), way.nodes.size()};
            way.nodes.push_back(drawing_.nodes.size());
            drawing_.nodes.push_back(line_->points[i]);
        }
        if (to) {
            way.nodes.push_back(node_at(*to));
        }
        drawing_.ways.push_back(std::move(way));
        const auto number = drawing_.ways.size() - 1;
        index_.add(points_of(drawing_, number), number);
    }

    std::size_t node_at(const TraceVertex& vertex) const {
        return drawing_.ways[vertex.way].nodes[vertex.point];
    }

    TraceConfig config_;
    InferredNetwork drawing_;
    TraceIndex index_;
    const TraceLine* line_ = nullptr; ///< line being drawn
    TraceIndex own_index_;
    std::vector<MaybeVertex> own_place_; ///< position of each of its points in the drawing
};

} // namespace

InferredNetwork drawing_of(const std::vector<TraceLine>& lines, const TraceConfig& config) {
    NetworkBuilder drawer{config};
    for (const auto& line : lines) {
        drawer.draw(line, false, false);
    }
    return drawer.take();
}

InferredNetwork
drawn_again(const InferredNetwork& drawing, double sd_m, const TraceConfig& config) {
    NetworkBuilder drawer{config};
    for (const bool of_many : {true, false}) {
        for (std::size_t i = 0; i < drawing.ways.size(); ++i) {
            const auto& way = drawing.ways[i];
            if ((way.passes >= many_passes) == of_many) {
                drawer.draw({points_of(drawing, i), sd_m}, way.attached_from, way.attached_to);
            }
        }
    }
    return drawer.take();
}

} // namespace macadam
