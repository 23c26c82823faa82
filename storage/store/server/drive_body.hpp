#pragma once

#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Pass of a drive over a chunk. The segment and the drive of `pass` are not part of its body.
struct DrivePass {
    std::uint32_t offset; ///< of the segment in its chunk, from 0
    Pass pass;
};

/// Packs the passes of one drive into bytes, 15 to 25 a pass, ordered by (offset, occurrence).
///
/// A byte 1 for the format, then for each pass: offset minus that of the pass before; occurrence;
/// flags (1 left, 2 right, 4 centre known, 8 centre_only); validity; left, right, centre if known;
/// iri, sd, speed, covered, confidence and t. Numbers are LEB128; all but the first four as zigzag
/// of the difference to the value of the pass before, iri to the mean of both tracks if they are
/// known. SQL function macadam.passes_in() unpacks the same.
std::string body_of(std::vector<DrivePass> passes);

/// Unpacks them.
///
/// \param segments_per_chunk  offsets are below.
/// \throws InputError  without a location, for bytes that body_of() does not make.
std::vector<DrivePass> passes_in_body(std::string_view body, std::uint32_t segments_per_chunk);

} // namespace macadam
