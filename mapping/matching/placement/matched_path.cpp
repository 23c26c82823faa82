#include "mapping/matching/placement/matched_path.hpp"

#include "mapping/matching/placement/path_ends.hpp"

#include <algorithm>

namespace macadam {
namespace {

constexpr std::size_t longest_bad_run = 2; // samples
constexpr double longest_path_m = 1e6;     // limits memory; the next path begins there
constexpr double bad_run_nats = 6;         // cost of the transition over it: more is an excursion

/// A transition with the edges between.
struct Connection {
    Transition move;
    std::vector<EdgeId> edges;
};

/// Assigns an interval without samples the lower confidence of its neighbours.
void vouch_for_unseen(std::vector<PathInterval>& intervals) {
    for (std::size_t first = 0; first < intervals.size(); ++first) {
        if (intervals[first].confidence > 0 || first == 0) {
            continue;
        }
        auto seen = first;
        while (seen + 1 < intervals.size() && intervals[seen].confidence == 0) {
            ++seen;
        }
        for (auto i = first; i < seen; ++i) {
            intervals[i].confidence =
                std::min(intervals[first - 1].confidence, intervals[seen].confidence);
        }
        first = seen;
    }
}

class PathBuilder {
public:
    PathBuilder(const RoadNetwork& roads,
                CandidateIndex& plane,
                EdgeRouter& routes,
                const MatchObservations& positions,
                const std::vector<BestState>& chain,
                const MatchConfig& config)
        : roads_{roads}, plane_{plane}, routes_{routes},
          positions_{positions}, chain_{chain}, config_{config} {}

    std::vector<RoadPath> build() && {
        for (std::size_t sample = 0; sample < chain_.size(); ++sample) {
            if (chain_[sample].candidate.off_network) {
                continue;
            }
            if (paths_.empty() || !extend(sample)) {
                begin(sample);
            }
        }
        for (auto& path : paths_) {
            path.intervals.back().to_m = length_m(roads_, path.intervals.back().edge);
            vouch_for_unseen(path.intervals);
            settle(path);
            trim(path, roads_);
        }
        return std::move(paths_);
    }

private:
    void begin(std::size_t sample) {
        const auto& candidate = chain_[sample].candidate;
        paths_.push_back({{}, {}, {}, sample, sample});
        paths_.back().intervals.push_back({candidate.edge, 0, 0, 0, 0});
        place(sample);
    }

    /// Places a sample on the last interval of the path.
    void place(std::size_t sample) {
        auto& path = paths_.back();
        auto& interval = path.intervals.back();
        path.positions.push_back(chain_[sample].position);
        path.sample_m.push_back(interval.start_m + chain_[sample].candidate.offset_m -
                                interval.from_m);
        path.last_sample = sample;
        interval.confidence = std::max(interval.confidence, chain_[sample].confidence);
    }

    bool extend(std::size_t sample) {
        const auto last = paths_.back().last_sample;
        const auto skipped = sample - last - 1;
        if (skipped > longest_bad_run || (skipped == 0 && !chain_[sample].joined) ||
            paths_.back().intervals.back().start_m > longest_path_m) {
            return false;
        }
        const auto between =
            between_samples(positions_, chain_[last].position, chain_[sample].position, config_);
        const auto connection = connect(last, sample, between);
        if (!connection || (skipped > 0 && cost_of(connection->move, between) > bad_run_nats)) {
            return false;
        }
        follow(*connection, last, sample);
        place(sample);
        return true;
    }

    std::optional<Connection>
    connect(std::size_t from_sample, std::size_t to_sample, const SamplePair& between) {
        const auto& from = chain_[from_sample].candidate;
        const auto& to = chain_[to_sample].candidate;
        const auto& reached =
            reached_from(routes_, from.edge, std::span{&to.edge, 1}, between, config_);
        const auto move = move_of(roads_, reached, from, to, between, config_);
        if (!move) {
            return {};
        }
        return Connection{*move,
                          move->kind == Transition::Kind::around
                              ? edges_before(reached, from.edge, to.edge)
                              : std::vector<EdgeId>{}};
    }

    void follow(const Connection& connection, std::size_t last, std::size_t sample) {
        const auto& from = chain_[last].candidate;
        const auto& to = chain_[sample].candidate;
        switch (connection.move.kind) {
        case Transition::Kind::along:
            break;
        case Transition::Kind::turned: {
            // The way there and back equals the travelled distance; the turning point remains
            // undetermined.
            const double edge_m = length_m(roads_, from.edge);
            const double turn_m =
                (from.offset_m + edge_m - to.offset_m + connection.move.way_m) / 2;
            go_on(to.edge, turn_m, edge_m - turn_m);
            break;
        }
        case Transition::Kind::around:
            for (const auto edge : connection.edges) {
                go_on(edge, length_m(roads_, paths_.back().intervals.back().edge), 0);
            }
            go_on(to.edge, length_m(roads_, paths_.back().intervals.back().edge), 0);
            break;
        }
    }

    /// Adjusts the ends of a path at a gap to the positions; at the ends of the trip all positions
    /// belong to it.
    void settle(RoadPath& path) {
        if (path.first_sample > 0) {
            settle_begin(path, roads_, plane_, positions_, chain_[path.first_sample - 1].position);
        }
        if (path.last_sample + 1 < chain_.size()) {
            settle_end(path, roads_, plane_, positions_, chain_[path.last_sample + 1].position);
        }
    }

    /// Ends the last interval at `end_m` of its edge and begins the next at `begin_m` of its own.
    void go_on(EdgeId edge, double end_m, double begin_m) {
        auto& intervals = paths_.back().intervals;
        auto& interval = intervals.back();
        interval.to_m = std::max(end_m, interval.from_m);
        const double start_m = interval.start_m + interval.to_m - interval.from_m;
        intervals.push_back({edge, begin_m, begin_m, start_m, 0});
    }

    const RoadNetwork& roads_;
    CandidateIndex& plane_;
    EdgeRouter& routes_;
    const MatchObservations& positions_;
    const std::vector<BestState>& chain_;
    const MatchConfig& config_;
    std::vector<RoadPath> paths_;
};

} // namespace

double length_m(const RoadPath& path) {
    const auto& interval = path.intervals.back();
    return interval.start_m + interval.to_m - interval.from_m;
}

std::vector<RoadPath> paths_of(const RoadNetwork& roads,
                               CandidateIndex& plane,
                               EdgeRouter& routes,
                               const MatchObservations& positions,
                               const std::vector<BestState>& chain,
                               const MatchConfig& config) {
    return PathBuilder{roads, plane, routes, positions, chain, config}.build();
}

} // namespace macadam
