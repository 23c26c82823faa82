#pragma once

#include "estimator/common/trip.hpp"

#include <string>
#include <vector>

namespace macadam {

/// A line "# key: value" of a trip log's head.
struct MetaLine {
    std::string where; ///< "file:line"
    std::string key;
    std::string value;
};

/// What the head says. 'unknown' and an empty value are as good as no line; of two lines with one
/// key the later holds.
///
/// \throws InputError  for a value that its key does not allow.
TripMeta parse_meta(const std::vector<MetaLine>& lines);

/// The lines "# key: value" that say the same, each with its newline; numbers with as many digits
/// as it takes to read the same again. Line breaks in a text become blanks.
std::string meta_text(const TripMeta& meta);

} // namespace macadam
