#pragma once

#include "estimator/common/trip.hpp"

#include <cstddef>
#include <filesystem>
#include <stop_token>

namespace macadam {

/// Writes a trip as a rawlog that MRPT's tools read (gzip, as they write it): first a
/// CObservationComment with the head of the trip, then in the order of their times CObservationIMU
/// (label "imu"), CObservationOdometry ("wheels") and CObservationGPS ("gnss"). The file appears
/// when it is whole, or not at all; equal trips give equal bytes. \returns how many objects it has.
///
/// read_rawlog gives the same trip back: values as they are, times to 100 ns, MRPT's unit. A trip
/// without t0_utc begins in 1970. The pose of the odometry is the distance driven, straight ahead.
///
/// \param level  of compression: 1 (fast) to 9 (small).
/// \throws InputError  if the file cannot be written, or when `stop` is requested before it is
///                     whole.
std::size_t write_rawlog(const TripLog& trip,
                         const std::filesystem::path& file,
                         int level = 6,
                         const std::stop_token& stop = {});

} // namespace macadam
