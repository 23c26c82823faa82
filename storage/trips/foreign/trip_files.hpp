#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Name of a file of a trip, for messages.
std::string name_of_file(const TripSource& source, const std::string& file);

/// Reads the files of a foreign trip into memory, decompressed, if they are not yet: its parsers
/// look at some of them several times.
/// \throws InputError  if one cannot be read.
TripSource with_contents(TripSource source);

/// Content of one of the files of a trip with contents.
/// \throws InputError  if it could not be read, or there is none of this name.
std::string_view text_of_file(const TripSource& source, const std::string& file);

/// Opens one of the files of a trip with contents.
/// \throws InputError  if it could not be read, or there is none of this name.
std::unique_ptr<ByteStream> bytes_of_file(const TripSource& source, const std::string& file);

} // namespace macadam
