#pragma once

#include "storage/files/byte_stream.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Decompressed files of one trip, in memory: from an archive, or of a foreign trip.
struct TripContents {
    struct File {
        std::string name; ///< within the trip's folder; "" for a single log
        std::string bytes;
        std::string refusal; ///< reason why it cannot be read; "" if it can
    };
    std::vector<File> files;
};

/// Opens one of the files; the stream keeps the contents alive.
///
/// \throws InputError  with its refusal.
/// \returns null if there is no file of that name.
std::unique_ptr<ByteStream> bytes_of(const std::shared_ptr<const TripContents>& contents,
                                     std::string_view name);

} // namespace macadam
