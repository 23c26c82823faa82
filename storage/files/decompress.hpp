#pragma once

#include "storage/files/byte_stream.hpp"

namespace macadam {

/// Decompresses `from` if it begins like gzip or Zstandard, and passes it through otherwise. A
/// truncated stream and a checksum error are errors, and so is a decompression bomb: more than 1
/// GiB, or more than 100 times the bytes read from disk once 16 MiB have been decompressed.
///
/// \param name  for messages.
std::unique_ptr<ByteStream> decompressed(std::unique_ptr<ByteStream> from, const std::string& name);

/// Applies the same limits to `from` without decompressing it, for content that an archive has
/// already decompressed.
std::unique_ptr<ByteStream> bounded(std::unique_ptr<ByteStream> from, const std::string& name);

} // namespace macadam
