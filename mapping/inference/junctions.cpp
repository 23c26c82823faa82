#include "mapping/inference/junctions.hpp"

#include <algorithm>
#include <queue>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t slack = 3;          // points by which a line may join a way late or early
constexpr std::size_t crossing_reach = 6; // points around a turn within which two ways may cross
constexpr double longest_joint_m = 150;   // longer joints are ways that were drawn
constexpr double detour_m = 60;           // corner that a line may have cut off

/// A turn of a line from one way to another.
struct Turn {
    TraceVertex from;
    TraceVertex to;
    std::vector<PointEn> between;
    bool is_round;
};

/// Returns true if a line merely continued along its way, `steps` points later; a way may also
/// cross itself.
bool goes_along(const TraceVertex& from, const TraceVertex& to, std::size_t steps) {
    return from.way == to.way && to.point + slack >= from.point &&
           to.point <= from.point + steps + 2 * slack;
}

std::vector<Turn> turns_of(const std::vector<TraceLine>& lines,
                           const InferredNetwork& drawing,
                           const TraceConfig& config) {
    TraceIndex index{config};
    for (std::size_t way = 0; way < drawing.ways.size(); ++way) {
        index.add(points_of(drawing, way), way);
    }
    std::vector<Turn> turns;
    std::optional<TraceVertex> last;
    std::vector<PointEn> between;
    for (const auto& line : lines) {
        if (!line.after_turn) {
            last.reset();
        }
        between.clear();
        bool is_round = line.after_turn;
        const auto joins = joins_of(line, index, config);
        for (std::size_t i = 0; i < joins.size(); ++i) {
            if (!joins[i]) {
                between.push_back(line.points[i]);
                continue;
            }
            const auto& here = joins[i]->at;
            if (last && !goes_along(*last, here, between.size() + 1)) {
                turns.push_back({*last, here, between, is_round});
            }
            last = here;
            between.clear();
            is_round = false;
        }
    }
    return turns;
}

/// A crossing of two ways, between their steps from_step and to_step.
struct Crossing {
    std::size_t from_step;
    std::size_t to_step;
    double from_share;
    PointEn at;
};

std::optional<Crossing> crossing_of(const std::vector<PointEn>& a,
                                    std::size_t i,
                                    const std::vector<PointEn>& b,
                                    std::size_t k) {
    const double ae = a[i + 1].east_m - a[i].east_m;
    const double an = a[i + 1].north_m - a[i].north_m;
    const double be = b[k + 1].east_m - b[k].east_m;
    const double bn = b[k + 1].north_m - b[k].north_m;
    const double cross = ae * bn - an * be;
    if (cross == 0) {
        return std::nullopt;
    }
    const double de = b[k].east_m - a[i].east_m;
    const double dn = b[k].north_m - a[i].north_m;
    const double on_a = (de * bn - dn * be) / cross;
    const double on_b = (de * an - dn * ae) / cross;
    if (!(on_a >= 0 && on_a < 1 && on_b >= 0 && on_b < 1)) {
        return std::nullopt;
    }
    return Crossing{i, k, on_a, {a[i].east_m + on_a * ae, a[i].north_m + on_a * an}};
}

/// Joins the ways of an inferred network.
class JunctionBuilder {
public:
    explicit JunctionBuilder(InferredNetwork drawing) : drawing_{std::move(drawing)} {
        next_.resize(drawing_.nodes.size());
        for (const auto& way : drawing_.ways) {
            for (std::size_t i = 1; i < way.nodes.size(); ++i) {
                next_[way.nodes[i - 1]].push_back(way.nodes[i]);
            }
        }
        inserted_.resize(drawing_.ways.size());
    }

    void join(const Turn& turn, const TraceConfig& config) {
        if (turn.is_round) {
            join_ends(turn);
            return;
        }
        const double gap_m = gap_of(turn);
        if (gap_m > longest_joint_m || is_way(turn, gap_m + detour_m)) {
            return;
        }
        if (const auto crossing = crossing_near(turn)) {
            add_node(turn, *crossing);
        } else {
            add_way(turn, config);
        }
    }

    InferredNetwork take() {
        for (std::size_t way = 0; way < inserted_.size(); ++way) {
            auto& nodes = drawing_.ways[way].nodes;
            std::ranges::stable_sort(inserted_[way], {}, [](const Inserted& i) {
                return std::pair{i.step, i.share};
            });
            for (auto each = inserted_[way].rbegin(); each != inserted_[way].rend(); ++each) {
                nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(each->step) + 1,
                             each->node);
            }
        }
        return std::move(drawing_);
    }

private:
    const PointEn& point(const TraceVertex& vertex) const { return drawing_.nodes[node(vertex)]; }
    std::size_t node(const TraceVertex& vertex) const {
        return drawing_.ways[vertex.way].nodes[vertex.point];
    }
    std::size_t last_of(std::size_t way) const { return drawing_.ways[way].nodes.size() - 1; }

    double gap_of(const Turn& turn) const {
        double sum_m = 0;
        auto last = point(turn.from);
        for (const auto& at : turn.between) {
            sum_m += apart_m(last, at);
            last = at;
        }
        return sum_m + apart_m(last, point(turn.to));
    }

    /// Returns true if the network already connects the two ways without a long detour.
    bool is_way(const Turn& turn, double max_m) const {
        const auto first = turn.to.point - std::min(turn.to.point, slack);
        const auto end = std::min(turn.to.point + 2 * slack, last_of(turn.to.way)) + 1;
        const auto& to = drawing_.ways[turn.to.way].nodes;
        const auto is_goal = [&](std::size_t n) {
            return std::find(to.begin() + static_cast<std::ptrdiff_t>(first),
                             to.begin() + static_cast<std::ptrdiff_t>(end),
                             n) != to.begin() + static_cast<std::ptrdiff_t>(end);
        };
        const TraceVertex start{turn.from.way, turn.from.point - std::min(turn.from.point, slack)};
        using Reached = std::pair<double, std::size_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
        std::vector<std::size_t> done;
        open.push({0, node(start)});
        while (!open.empty()) {
            const auto [gone_m, at] = open.top();
            open.pop();
            if (is_goal(at)) {
                return true;
            }
            if (std::ranges::find(done, at) != done.end()) {
                continue;
            }
            done.push_back(at);
            for (const auto next : next_[at]) {
                const double m = gone_m + apart_m(drawing_.nodes[at], drawing_.nodes[next]);
                if (m <= max_m + start_m(start, turn.from)) {
                    open.push({m, next});
                }
            }
        }
        return false;
    }

    double start_m(const TraceVertex& start, const TraceVertex& from) const {
        return apart_m(point(start), point(from));
    }

    std::optional<Crossing> crossing_near(const Turn& turn) const {
        const auto a = points_of(drawing_, turn.from.way);
        const auto b = points_of(drawing_, turn.to.way);
        const auto first = [](std::size_t i) { return i - std::min(i, crossing_reach); };
        for (auto i = first(turn.from.point);
             i < std::min(turn.from.point + crossing_reach, a.size() - 1);
             ++i) {
            for (auto k = first(turn.to.point);
                 k < std::min(turn.to.point + crossing_reach, b.size() - 1);
                 ++k) {
                const bool is_same = turn.from.way == turn.to.way && (i < k ? k - i : i - k) < 2;
                if (const auto crossing = crossing_of(a, i, b, k); crossing && !is_same) {
                    return crossing;
                }
            }
        }
        return std::nullopt;
    }

    void add_node(const Turn& turn, const Crossing& crossing) {
        const auto at = drawing_.nodes.size();
        drawing_.nodes.push_back(crossing.at);
        next_.emplace_back();
        insert(turn.from.way, crossing.from_step, at);
        insert(turn.to.way, crossing.to_step, at);
    }

    void insert(std::size_t way, std::size_t step, std::size_t at) {
        const auto& nodes = drawing_.ways[way].nodes;
        const double share = apart_m(drawing_.nodes[nodes[step]], drawing_.nodes[at]);
        inserted_[way].push_back({step, share, at});
        next_[nodes[step]].push_back(at);
        next_[at].push_back(nodes[step + 1]);
    }

    void add_way(const Turn& turn, const TraceConfig& config) {
        InferredWay way{.nodes = {node(turn.from)}, .attached_from = true, .attached_to = true};
        for (const auto& at : turn.between) {
            if (apart_m(at, point(turn.from)) > config.spacing_m / 2 &&
                apart_m(at, point(turn.to)) > config.spacing_m / 2) {
                way.nodes.push_back(drawing_.nodes.size());
                drawing_.nodes.push_back(at);
                next_.emplace_back();
            }
        }
        way.nodes.push_back(node(turn.to));
        for (std::size_t i = 1; i < way.nodes.size(); ++i) {
            next_[way.nodes[i - 1]].push_back(way.nodes[i]);
        }
        drawing_.ways.push_back(std::move(way));
        inserted_.emplace_back();
    }

    /// Joins a dead end: the way back begins where the way there ends.
    void join_ends(const Turn& turn) {
        const auto& there = drawing_.ways[turn.from.way];
        auto& back = drawing_.ways[turn.to.way];
        const bool at_ends = turn.from.point + slack >= last_of(turn.from.way) &&
                             turn.to.point <= slack && !there.attached_to && !back.attached_from;
        if (at_ends && turn.from.way != turn.to.way) {
            const auto end = there.nodes.back();
            next_[end].push_back(back.nodes.front());
            back.nodes.insert(back.nodes.begin(), end);
            back.attached_from = true;
            for (auto& each : inserted_[turn.to.way]) {
                ++each.step;
            }
        }
    }

    struct Inserted {
        std::size_t step;
        double share; ///< metres from the start of the step
        std::size_t node;
    };

    InferredNetwork drawing_;
    std::vector<std::vector<std::size_t>> next_;  ///< per node
    std::vector<std::vector<Inserted>> inserted_; ///< per way
};

} // namespace

InferredNetwork
joined(InferredNetwork drawing, const std::vector<TraceLine>& lines, const TraceConfig& config) {
    const auto turns = turns_of(lines, drawing, config);
    JunctionBuilder joiner{std::move(drawing)};
    for (const auto& turn : turns) {
        joiner.join(turn, config);
    }
    return joiner.take();
}

} // namespace macadam
