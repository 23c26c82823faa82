#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <span>

namespace macadam {

/// One metre of a trace.
struct TraceCell {
    RoughnessCode iri = no_roughness;
    RoughnessCode left = no_roughness;
};

/// The trace with these cells, from the first known one to the last; `trace.first_m` is where
/// `cells` begin and has no cells of its own yet. Empty where none is known.
RoughnessTrace with_cells(RoughnessTrace trace, std::span<const TraceCell> cells);

} // namespace macadam
