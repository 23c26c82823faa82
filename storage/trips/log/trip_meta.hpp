#pragma once

#include "estimator/common/trip.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Line "# key: value" in the header of a trip log.
struct MetaLine {
    std::string where; ///< "file:line"
    std::string key;
    std::string value;
};

/// Parses the header lines. 'unknown' and an empty value count as missing; of two lines with the
/// same key, the later applies.
///
/// \throws InputError  for an invalid value.
TripMeta parse_meta(const std::vector<MetaLine>& lines);

/// Formats meta data as lines "# key: value", each with its line end; numbers have enough digits to
/// be restored exactly. Line breaks in a text become blanks.
std::string meta_text(const TripMeta& meta);

/// Length that the recorder left out at both ends of the trip and on both sides of long stops, as
/// `trimmed_m` of the log states it; 0 if it states none. At most 1,000 km.
double trimmed_before_m(const TripMeta& meta);

} // namespace macadam
