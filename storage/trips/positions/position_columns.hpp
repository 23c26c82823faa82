#pragma once

#include "storage/trips/source/trip_source.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Accuracy of a position per unit of HDOP, where the receiver does not state it: the range error
/// of a single-frequency receiver under open sky, one standard deviation.
///
/// Source: E. D. Kaplan, C. J. Hegarty (eds.), "Understanding GPS/GNSS", 3rd ed. (2017), chapter
/// 10: 4 to 7 m.
inline constexpr double hacc_per_hdop_m = 5;

/// \param what  "a GPX track", for messages
/// \throws InputError  if more than positions is required.
void expect_positions_to_do(const TripNeeds& needs, const std::string& name, std::string_view what);

} // namespace macadam
