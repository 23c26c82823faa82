#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

enum class GateDecision : std::uint8_t {
    dropped,  ///< contradicted by its neighbours
    follows,  ///< consistent with the last kept reading
    restarts, ///< first reading after a jump: its relation to the last kept one is unknown
};

/// Number of mutually consistent readings that outvotes the earlier ones.
inline constexpr std::size_t outvoting = 3;

/// Separates single outliers from true jumps in a sequence of readings.
///
/// A reading that is inconsistent with the last kept one waits. Once `outvoting` waiting readings
/// are consistent with each other for long enough, they are kept and the first of them restarts; if
/// a later reading is consistent with the last kept one, the waiting ones were outliers.
///
/// \param follows      whether reading j can come after reading i < j; false for i = j if the
///                     reading is invalid by itself.
/// \param long_enough  whether the agreement of readings i to j outvotes the last kept one.
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
