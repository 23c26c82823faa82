#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/trips/mappings/column_mapping.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// First lines of a text file, from which its layout is detected.
struct TextSample {
    std::vector<std::string> lines{};           ///< without line ends, in UTF-8
    TextEncoding encoding = TextEncoding::utf8; ///< what a mapping has to state
};

/// Reads the first 4 MiB of a file, at most 40,000 lines; an incomplete last line is dropped.
///
/// \param bytes  decompressed.
/// \returns `std::nullopt` if the file is not text.
/// \throws InputError  if the file cannot be read.
std::optional<TextSample> read_text_sample(ByteStream& bytes, const std::string& name);

} // namespace macadam
