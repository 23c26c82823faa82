#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

enum class GateDecision : std::uint8_t {
    dropped,  ///< its neighbours contradict it
    follows,  ///< from the one kept before it
    restarts, ///< the world jumped: nothing is known between it and the one kept before it
};

/// How many that agree among themselves outvote what was believed before.
inline constexpr std::size_t outvoting = 3;

/// Sorts single faults from true jumps in a row of readings.
///
/// A reading that cannot follow from the last one kept waits. If `outvoting` readings that wait
/// follow from each other long enough they are kept, and the first of them restarts; if a later one
/// follows from the last one kept again, those that waited were faults.
///
/// \param follows      whether reading j can come after reading i < j; false for i = j if the
///                     reading is worth nothing by itself.
/// \param long_enough  whether what readings i to j agree on outvotes what was believed before.
template <typename Follows, typename LongEnough>
std::vector<GateDecision>
gate_outliers(std::size_t count, Follows follows, LongEnough long_enough) {
    std::vector<GateDecision> links(count, GateDecision::dropped);
    std::vector<std::size_t> waiting;
    bool begun = false;
    std::size_t last = 0;
    const auto keep_waiting = [&] {
        for (const auto i : waiting) {
            links[i] = GateDecision::follows;
        }
        links[waiting.front()] = begun ? GateDecision::restarts : GateDecision::follows;
        last = waiting.back();
        begun = true;
        waiting.clear();
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (!follows(i, i)) {
            continue;
        }
        if (begun && follows(last, i)) {
            links[i] = GateDecision::follows;
            last = i;
            waiting.clear();
            continue;
        }
        if (!waiting.empty() && !follows(waiting.back(), i)) {
            waiting.clear();
        }
        waiting.push_back(i);
        if (waiting.size() >= outvoting && long_enough(waiting.front(), i)) {
            keep_waiting();
        }
    }
    if (!begun && !waiting.empty()) {
        keep_waiting();
    }
    return links;
}

} // namespace macadam
