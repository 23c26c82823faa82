#pragma once

#include "mapping/network/segment.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// About 500 m of one way in one direction: segments whose passes are laid on each other together.
/// A whole number of segments, counted from the way's first node; the last chunk of a way is what
/// is left.
struct ChunkKey {
    std::int64_t way_id;
    bool forward;
    std::uint32_t number;
    friend bool operator==(const ChunkKey&, const ChunkKey&) = default;
};

inline constexpr double chunk_length_m = 500;

/// \param segment_length_m  of the network's segments, as asked for. > 0.
std::uint32_t segments_per_chunk(double segment_length_m);
ChunkKey chunk_of(const SegmentKey& segment, double segment_length_m);

/// A place along a way that rises in driving direction: metres from the way's first node when
/// driven forward, minus these when driven backward.
double station_m(bool forward, double along_way_m);

/// Roughness in one byte, 255 for none: 5 bits of mantissa and 3 of exponent in steps of 0.02 mm/m,
/// so that a value is right to 1.6 % or 0.01 mm/m, and 79.36 mm/m is the most.
///
/// Source: the segments of equal steps of ITU-T G.711.
using RoughnessCode = std::uint8_t;
inline constexpr RoughnessCode no_roughness = 255;
RoughnessCode code_of(double mm_per_m);                     ///< >= 0; the nearest
std::optional<std::int32_t> um_of(RoughnessCode roughness); ///< micrometres per metre

/// What one drive over a chunk read of it, metre by metre: the trip's own roughness where the match
/// puts it, with 10 m before and behind so that it can be moved. Cell i lies between the stations
/// first_m + i and first_m + i + 1.
struct RoughnessTrace {
    ChunkKey chunk;
    std::uint32_t drive; ///< 0 for the trip's first drive over the chunk, then 1, 2, ...
    std::int32_t first_m;
    std::vector<RoughnessCode> iri;  ///< the headline; the first and the last cell are known
    std::vector<RoughnessCode> left; ///< of the left track; empty: tracks not observed
    std::int32_t place_sd_mm;        ///< of the place along the road, > 0, the mean of the drive
    friend bool operator==(const RoughnessTrace&, const RoughnessTrace&) = default;
};

inline constexpr double trace_margin_m = 10;

} // namespace macadam
