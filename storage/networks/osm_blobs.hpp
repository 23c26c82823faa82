#pragma once

#include "storage/files/byte_stream.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Reads the blobs of an .osm.pbf file in sequence: raw or zlib, of at most 32 MiB.
///
/// \throws InputError  if the file is truncated, damaged or compressed differently, or decompresses
///                     to more than a map would.
class OsmBlobs {
public:
    explicit OsmBlobs(const std::filesystem::path& file);

    struct Blob {
        std::string type;
        std::string_view content; ///< decompressed; valid until the next call
    };

    /// Returns the next blob; `std::nullopt` at the end of the file.
    std::optional<Blob> next();

    /// Bytes of the file read so far.
    std::uint64_t consumed() const { return bytes_->consumed(); }

private:
    bool fill(std::span<char> into, bool may_end);
    std::string_view unpacked();
    std::string_view inflated(std::string_view zlib, std::int32_t raw_bytes);

    std::unique_ptr<ByteStream> bytes_;
    std::uint64_t file_bytes_;
    std::uint64_t unpacked_bytes_ = 0;
    std::string packed_;
    std::string inflated_;
};

} // namespace macadam
