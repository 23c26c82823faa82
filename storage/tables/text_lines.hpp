#pragma once

#include "storage/files/byte_stream.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Reads a text line by line, in blocks of 1 MiB. Lines end in LF or CRLF; a byte order mark is
/// dropped.
class TextLines {
public:
    /// \param name  name of the file, for messages.
    TextLines(std::unique_ptr<ByteStream> bytes, std::string name);

    /// Returns the next line, valid until the next call; `std::nullopt` at the end.
    ///
    /// \throws InputError  if the line holds a NUL byte or is longer than 1 MiB, because then the
    ///                     file is not text.
    std::optional<std::string_view> next();

    /// "file:line" of the last line returned; of the first line before any was returned.
    std::string where() const;

private:
    void fill();
    std::string_view taken(std::size_t size, std::size_t skip);

    std::unique_ptr<ByteStream> bytes_;
    std::string name_;
    std::vector<char> block_;
    std::size_t first_ = 0; ///< start of the unread bytes of the block, [first_, last_)
    std::size_t last_ = 0;
    std::size_t number_ = 0;
    bool ended_ = false;
    bool has_nul_ = false;
};

} // namespace macadam
