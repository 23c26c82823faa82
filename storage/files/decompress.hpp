#pragma once

#include "storage/files/byte_stream.hpp"

namespace macadam {

/// What `from` holds: decompressed if it begins like gzip or Zstandard, and otherwise as it is. A
/// compressed stream that ends too early or fails its checksum is an error, and so is one that
/// grows beyond all reason (a bomb): over 1 GiB, or over 100 times what was read from disk
/// once 16 MiB have come out.
///
/// \param name  for messages.
std::unique_ptr<ByteStream> decompressed(std::unique_ptr<ByteStream> from, const std::string& name);

/// `from`, limited in the same way: for what an archive has decompressed already.
std::unique_ptr<ByteStream> bounded(std::unique_ptr<ByteStream> from, const std::string& name);

} // namespace macadam
