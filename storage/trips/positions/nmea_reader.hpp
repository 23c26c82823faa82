#pragma once

#include "estimator/common/trip.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Tests for the name of an NMEA recording: .nmea, .nmea.gz or .nmea.zst.
bool is_nmea_name(std::string_view name);

/// Tests whether a text begins like an NMEA recording: one of its lines is a sentence with a
/// correct checksum.
///
/// \param head  first bytes of a file
bool is_nmea_text(std::string_view head);

/// Reads an NMEA 0183 recording as a trip. Each line is a row: RMC, GGA and VTG of one time of day
/// are one fix, at the first of them (the others are `merged`); other sentences are
/// `unused_channel`; a line without a correct checksum, and a sentence with a bad number, are
/// `bad_number`. Text before the '$' is ignored. Times are UTC if any valid RMC states a date.
///
/// \param bytes  decompressed
/// \param name  for messages
///
/// \throws InputError  "file: ..." if it holds no RMC or GGA with a correct checksum; or if a
///                     column is required that a receiver does not give.
TripLog
read_nmea(std::unique_ptr<ByteStream> bytes, const std::string& name, const TripNeeds& needs);

} // namespace macadam
