#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/trips/foreign/column_mapping.hpp"

#include <memory>
#include <string>

namespace macadam {

/// `from` as UTF-8. UTF-16 with the low byte first is taken for such where it is stated or its byte
/// order mark says so; anything else is handed on as it is.
///
/// \throws InputError  on reading, if the mark is of UTF-16 with the high byte first.
std::unique_ptr<ByteStream>
decoded(std::unique_ptr<ByteStream> from, TextEncoding encoding, const std::string& name);

} // namespace macadam
