#pragma once

#include "mapping/passes/pass.hpp"
#include "storage/sqlite/bulk_insert.hpp"

#include <cstdint>
#include <optional>

namespace macadam {

/// Returns the number as tables hold it.
template <typename Integer>
std::optional<std::int64_t> whole(const std::optional<Integer>& number) {
    return number ? std::optional<std::int64_t>{*number} : std::nullopt;
}

/// Adds a pass to rows of a pass table: segment, trip, the pass's values, drive.
///
/// \param segment  row of the segment.
/// \param trip     row of the trip.
inline void add_pass_row(BulkInsert& rows,
                         std::int64_t segment,
                         std::int64_t trip,
                         const Pass& pass,
                         const std::optional<std::int64_t>& drive) {
    rows.add(segment,
             trip,
             std::int64_t{pass.occurrence},
             whole(pass.iri_left_um),
             whole(pass.iri_right_um),
             whole(pass.iri_centre_um),
             std::int64_t{pass.iri_um},
             std::int64_t{pass.sd_um},
             pass.centre_only,
             std::int64_t{pass.validity},
             std::int64_t{pass.speed_mmps},
             std::int64_t{pass.covered_mm},
             std::int64_t{pass.confidence_ppm},
             pass.t_ms,
             drive);
}

} // namespace macadam
