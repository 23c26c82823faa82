#pragma once

#include "storage/files/byte_stream.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// The files of one trip as they came out of an archive: decompressed, in memory.
struct TripContents {
    struct File {
        std::string name; ///< in the trip's folder; "" for a log of its own
        std::string bytes;
        std::string refusal; ///< why it cannot be read; "": it can
    };
    std::vector<File> files;
};

/// The bytes of one of the files. They keep the contents alive.
///
/// \throws InputError  its refusal.
///
/// \returns  null if there is none of that name.
std::unique_ptr<ByteStream> bytes_of(const std::shared_ptr<const TripContents>& contents,
                                     std::string_view name);

} // namespace macadam
