#include "mapping/matching/lattice/gap.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

constexpr double parked_s = 180;    // longer than stops at traffic lights and barriers
constexpr double parked_mps = 0.25; // receivers wander by tens of metres while a car stands

bool is_off(const BestState& chosen) {
    return chosen.candidate.off_network;
}

/// Returns the longest stop between two samples off the network; 0 if none counts as parking.
double stood_s(const MatchObservations& positions, std::span<const BestState> chain) {
    double longest_s = 0;
    for (std::size_t i = 1; i < chain.size(); ++i) {
        const auto& a = positions.all[chain[i - 1].position];
        const auto& b = positions.all[chain[i].position];
        const double took_s = b.t_s - a.t_s;
        const double moved_m = std::hypot(b.at.east_m - a.at.east_m, b.at.north_m - a.at.north_m);
        if ((is_off(chain[i - 1]) || is_off(chain[i])) && moved_m < parked_mps * took_s) {
            longest_s = std::max(longest_s, took_s);
        }
    }
    return longest_s >= parked_s ? longest_s : 0;
}

} // namespace

NetworkGap hole_between(const MatchObservations& positions,
                        const std::vector<BestState>& chain,
                        std::size_t from,
                        std::size_t to,
                        const MatchConfig& config) {
    const auto inside = std::span{chain}.subspan(from, to - from);
    if (std::any_of(inside.begin(), inside.end(), is_off)) {
        const auto whole = std::span{chain}.subspan(from, std::min(to + 1, chain.size()) - from);
        const double stand_s = stood_s(positions, whole);
        return {IntervalKind::off_network,
                fmt::format("no fitting road within {:g} m{}",
                            config.off_network_m,
                            stand_s > 0 ? fmt::format(", parked for {:.0f} s", stand_s) : "")};
    }
    if (from < to && to < chain.size() &&
        between_samples(positions, chain[to - 1].position, chain[to].position, config).dense) {
        return {IntervalKind::off_network, "no road joins the positions"};
    }
    return {IntervalKind::gap, "no way on the network joins the positions"};
}

} // namespace macadam
