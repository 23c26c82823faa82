#pragma once

#include "estimator/common/trip.hpp"

#include <cstddef>
#include <filesystem>
#include <stop_token>

namespace macadam {

/// Writes a trip as a "macadam-trip 1" log; the suffix selects the compression. The file appears
/// complete or not at all. Equal trips give equal bytes.
/// \returns the number of rows.
///
/// Samples whose time stamps agree to the microsecond share a row. Only columns with data are
/// written, with fixed decimals: t_s and gyro 6, accelerations 5, speeds and course 4, accuracy 3,
/// latitude and longitude 8 (1 mm). Reading the log restores the samples to these digits.
/// Consecutive fixes with equal values, as of a parked car, would be taken for one repeated fix:
/// then a column gnss_utc_s distinguishes them by the time stamp (plus t0_utc, if known).
///
/// Rows without samples and unknown columns are not part of a TripLog and are not written.
///
/// \param level  compression level: 1 (fast) to 9 (small).
/// \throws InputError  for another suffix, if the file cannot be written, or if `stop` is requested
///                     before the file is complete.
std::size_t write_trip(const TripLog& trip,
                       const std::filesystem::path& file,
                       int level = 6,
                       const std::stop_token& stop = {});

} // namespace macadam
