#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <span>

namespace macadam {

/// One metre of a trace.
struct TraceCell {
    RoughnessCode iri = no_roughness;
    RoughnessCode left = no_roughness;
};

/// Fills a trace with these cells, from the first known to the last; `trace.first_m` is the start
/// of `cells`, and the trace has no cells yet. Empty if no cell is known.
RoughnessTrace with_cells(RoughnessTrace trace, std::span<const TraceCell> cells);

} // namespace macadam
