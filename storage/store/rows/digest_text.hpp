#pragma once

#include "mapping/fusion/segment_state.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Lines of the text over which the digest is (docs/reference/database.md), the same for every
// engine. `std::nullopt` is a value that is not known.

using DigestNumbers = std::vector<std::optional<std::int64_t>>;

/// \param numbers  of the pass, as numbers_for_digest() gives them.
std::string digest_line_of_pass(bool is_reference,
                                std::string_view segment,
                                std::string_view trip_sha256,
                                const DigestNumbers& numbers);

DigestNumbers numbers_for_digest(const Pass& pass);

std::string digest_line_of_state(const SegmentState& state);

/// Line of a trip that was searched for events.
std::string digest_line_of_search(std::string_view trip_sha256);

/// \param numbers  occurrence, kind, track, at, place_sd, size, sd, length.
std::string digest_line_of_event(std::string_view segment,
                                 std::string_view trip_sha256,
                                 const DigestNumbers& numbers);

} // namespace macadam
