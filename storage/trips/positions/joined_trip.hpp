#pragma once

#include "estimator/common/trip.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <stop_token>
#include <string>

namespace macadam {

/// Key of TripMeta::other: how the clocks of a log and of its positions were joined, in words.
inline constexpr const char* positions_key = "positions";

/// Joins the positions of a receiver's recording to a log. If both state their times in UTC, these
/// are taken, with a doubt in `positions_key` if speeds and turns tell otherwise; otherwise the
/// offset between the clocks is found (find_clock_offset), and a date that only the positions have
/// becomes that of the log. The rows of the positions follow those of the log.
///
/// \param log        read with needs_beside_positions (trip_source.hpp)
/// \param file       name of the file with the positions, for messages
/// \throws InputError  if the two do not overlap, or no single offset is likely.
TripLog joined_trip(TripLog log,
                    TripLog positions,
                    const TripNeeds& needs,
                    const std::string& file,
                    const std::stop_token& stop);

} // namespace macadam
