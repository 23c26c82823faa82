#pragma once

#include "mapping/network/segment.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// About 500 m of one way in one direction, whose passes are aligned together. A whole number of
/// segments, counted from the way's first node; the last chunk of a way holds the remainder.
struct ChunkKey {
    std::int64_t way_id;
    bool forward;
    std::uint32_t number;
    friend bool operator==(const ChunkKey&, const ChunkKey&) = default;
};

inline constexpr double chunk_length_m = 500;

/// \param segment_length_m  nominal length of the network's segments. > 0.
std::uint32_t segments_per_chunk(double segment_length_m);
ChunkKey chunk_of(const SegmentKey& segment, double segment_length_m);

/// Converts a distance along a way to a station that increases in driving direction: metres from
/// the way's first node when driven forward, their negative when driven backward.
double station_m(bool forward, double along_way_m);

/// Roughness in one byte, 255 for none: 5 bits of mantissa and 3 of exponent in steps of 0.02 mm/m,
/// accurate to 1.6 % or 0.01 mm/m; the maximum is 79.36 mm/m.
///
/// Source: the segments of equal steps of ITU-T G.711.
using RoughnessCode = std::uint8_t;
inline constexpr RoughnessCode no_roughness = 255;
RoughnessCode code_of(double mm_per_m);                     ///< >= 0; the nearest code
std::optional<std::int32_t> um_of(RoughnessCode roughness); ///< micrometres per metre

/// Roughness read by one drive over a chunk, metre by metre: the trip's own roughness at its
/// matched positions, with 10 m before and behind so that it can be shifted. Cell i lies between
/// the stations first_m + i and first_m + i + 1.
struct RoughnessTrace {
    ChunkKey chunk;
    std::uint32_t drive; ///< 0 for the trip's first drive over the chunk, then 1, 2, ...
    std::int32_t first_m;
    std::vector<RoughnessCode> iri;  ///< the headline; first and last cell are known
    std::vector<RoughnessCode> left; ///< of the left track; empty: tracks not observed
    std::int32_t place_sd_mm;        ///< of the position along the road, > 0, mean of the drive
    friend bool operator==(const RoughnessTrace&, const RoughnessTrace&) = default;
};

inline constexpr double trace_margin_m = 10;

/// One metre of a trace.
struct TraceCell {
    RoughnessCode iri = no_roughness;
    RoughnessCode left = no_roughness;
};

/// Fills a trace with these cells, from the first known to the last; `trace.first_m` is the start
/// of `cells`, and the trace has no cells yet. Empty if no cell is known.
RoughnessTrace with_cells(RoughnessTrace trace, std::span<const TraceCell> cells);

} // namespace macadam
