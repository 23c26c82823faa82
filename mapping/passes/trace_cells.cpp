#include "mapping/passes/trace_cells.hpp"

#include <algorithm>

namespace macadam {

RoughnessTrace with_cells(RoughnessTrace trace, std::span<const TraceCell> cells) {
    const auto is_known = [](const TraceCell& cell) { return cell.iri != no_roughness; };
    const auto first = std::ranges::find_if(cells, is_known);
    const auto last = std::find_if(cells.rbegin(), cells.rend(), is_known).base();
    trace.first_m += static_cast<std::int32_t>(first - cells.begin());
    bool tracks = false;
    for (auto cell = first; cell < last; ++cell) {
        trace.iri.push_back(cell->iri);
        trace.left.push_back(cell->left);
        tracks = tracks || cell->left != no_roughness;
    }
    if (!tracks) {
        trace.left.clear();
    }
    return trace;
}

} // namespace macadam
