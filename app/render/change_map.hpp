#pragma once

#include "app/render/map_scene.hpp"
#include "mapping/analysis/change_since.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Verdict on a segment that was measured; `std::nullopt`: on one side of the day only.
struct SegmentVerdict {
    SegmentKey key;
    std::optional<Verdict> verdict;
};

/// Comparison of segments before and since a day.
struct ComparedStates {
    ChangeSince change;
    std::vector<SegmentKey> keys;         ///< of change.segments
    std::vector<SegmentVerdict> verdicts; ///< on all measured segments, in key order
};

/// Compares the segments of a filter before and since a day, within the filter's period. Its
/// minimum numbers of passes and cars count both sides together.
ComparedStates compare_since(const StoreReader& store, SegmentFilter filter, std::int64_t since_ms);

/// Returns the segments of a database that touch a box, those with a verdict in its class.
std::vector<MapLine> change_lines(const StoreReader& store,
                                  const GeoBox& box,
                                  std::span<const SegmentVerdict> verdicts,
                                  double scale_denominator);

/// Returns the verdicts on changes as classes of a map, from smoother to rougher. They have no
/// borders.
const ClassTable& change_classes();

/// Returns their colours on light or dark pages.
std::vector<std::uint32_t> change_colours(bool on_dark);

/// Plans a map of the changes since a day and loads its roads, as load_map does: comparable
/// segments by verdict, those measured on one side only in grey.
///
/// \throws InputError  as load_map.
MapPlan load_change_map(const StoreReader& store, MapRequest request, std::int64_t since_ms);

} // namespace macadam
