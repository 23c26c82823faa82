#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/files/sha256.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// The lines of a text, in blocks of a megabyte: ended by LF or CRLF, without a byte order mark.
class TextLines {
public:
    /// \param name  of the file, for messages.
    TextLines(std::unique_ptr<ByteStream> bytes, std::string name);

    /// Good until the next call. Nothing at the end.
    ///
    /// \throws InputError  if the line holds a NUL byte or is longer than a megabyte: no text is.
    std::optional<std::string_view> next();

    /// "file:line" of the last line; of the first before there was one.
    std::string where() const;

    std::uint64_t consumed() const { return bytes_->consumed(); }

    /// Of everything, once the last line was read.
    std::string sha256() { return sha256_.hex(); }

private:
    void fill();
    std::string_view taken(std::size_t size, std::size_t skip);

    std::unique_ptr<ByteStream> bytes_;
    std::string name_;
    Sha256 sha256_;
    std::vector<char> block_;
    std::size_t first_ = 0; ///< what is left of the block: [first_, last_)
    std::size_t last_ = 0;
    std::size_t number_ = 0;
    bool ended_ = false;
    bool has_nul_ = false;
};

} // namespace macadam
