#pragma once

#include "mapping/fusion/measured_segment.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace macadam {

/// Measured segments of a selection, and the roads on which they lie.
struct Survey {
    std::vector<MeasuredSegment> measured;   ///< in key order; their texts are in `texts`
    std::size_t segments = 0;                ///< on these roads
    std::map<std::string, double> network_m; ///< by highway tag
    std::shared_ptr<const std::set<std::string, std::less<>>> texts{};
};

/// Reads the measured segments that a filter selects, and the length of the roads that meet its
/// conditions on places.
Survey survey_of(const StoreReader& store, const SegmentFilter& filter);

} // namespace macadam
