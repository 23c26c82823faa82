#pragma once

#include "estimator/common/trip.hpp"

#include <cstddef>
#include <filesystem>
#include <stop_token>

namespace macadam {

/// Writes a trip as a rawlog for MRPT's tools (gzip, as they write it): first a CObservationComment
/// with the header of the trip, then, in time order, CObservationIMU (label "imu"),
/// CObservationOdometry ("wheels") and CObservationGPS ("gnss"). The file appears complete or not
/// at all; equal trips give equal bytes.
/// \returns the number of objects.
///
/// read_rawlog restores the trip: values exactly, times to 100 ns, MRPT's unit. A trip without
/// t0_utc begins in 1970. The odometry pose is the distance driven, straight ahead.
///
/// \param level  compression level: 1 (fast) to 9 (small).
/// \throws InputError  if the file cannot be written, or if `stop` is requested before the file is
///                     complete.
std::size_t write_rawlog(const TripLog& trip,
                         const std::filesystem::path& file,
                         int level = 6,
                         const std::stop_token& stop = {});

} // namespace macadam
