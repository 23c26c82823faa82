#include "mapping/privacy/drive_ends.hpp"

#include <cstddef>

namespace macadam {
namespace {

constexpr std::int64_t longest_pause_ms = 300'000;

} // namespace

std::vector<bool> in_end_blocks(std::span<const BlockVisit> visits) {
    std::vector<bool> at_end(visits.size());
    for (std::size_t first = 0; first < visits.size();) {
        std::size_t past = first + 1;
        while (past < visits.size() &&
               visits[past].t_ms - visits[past - 1].t_ms <= longest_pause_ms) {
            ++past;
        }
        for (auto i = first; i < past && visits[i].block == visits[first].block; ++i) {
            at_end[i] = true;
        }
        for (auto i = past; i > first && visits[i - 1].block == visits[past - 1].block; --i) {
            at_end[i - 1] = true;
        }
        first = past;
    }
    return at_end;
}

} // namespace macadam
