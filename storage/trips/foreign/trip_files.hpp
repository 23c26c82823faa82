#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <string>

namespace macadam {

/// Name of a file of a trip, for messages.
std::string name_of_file(const TripSource& source, const std::string& file);

/// Opens one of `source.files` from its folder or archive, decompressed.
std::unique_ptr<ByteStream> bytes_of_file(const TripSource& source, const std::string& file);

} // namespace macadam
