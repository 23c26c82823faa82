#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/trips/mappings/column_mapping.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Converts a text in ISO 8859-1 to UTF-8.
std::string utf8_of_latin1(std::string_view text);

/// Converts `from` to UTF-8. Little-endian UTF-16 is decoded if stated or marked by a byte order
/// mark, ISO 8859-1 if stated; anything else passes through unchanged.
///
/// \throws InputError  on reading, if the mark is that of big-endian UTF-16.
std::unique_ptr<ByteStream>
decoded(std::unique_ptr<ByteStream> from, TextEncoding encoding, const std::string& name);

} // namespace macadam
