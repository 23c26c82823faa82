#pragma once

#include "storage/files/byte_stream.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// The blobs of an .osm.pbf file, one after the other: raw or in zlib, of at most 32 MiB.
///
/// \throws InputError  where the file is cut off, damaged or packed otherwise, or unpacks to more
///                     than a map does.
class OsmBlobs {
public:
    explicit OsmBlobs(const std::filesystem::path& file);

    struct Blob {
        std::string type;
        std::string_view content; ///< unpacked; until the next call
    };

    /// Empty at the end of the file.
    std::optional<Blob> next();

    /// Bytes of the file that were read.
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
