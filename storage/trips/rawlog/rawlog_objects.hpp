#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/trips/rawlog/rawlog_layout.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

struct RawlogObject {
    RawlogClass kind; ///< never frame; also other for unsupported receiver messages
    std::string name; ///< class name
    std::string_view bytes;
};

/// Iterates over the objects of a rawlog, including those inside frames (CSensoryFrame). An object
/// of an unsupported class ends where the next object begins.
class RawlogObjects {
public:
    /// \param bytes  decompressed.
    /// \param name  name of the file, for messages.
    RawlogObjects(std::unique_ptr<ByteStream> bytes, std::string name);

    /// Next object, valid until the next call; `std::nullopt` at the end.
    ///
    /// \throws InputError  if the file is of another kind, is truncated, or holds anything that
    ///                     MRPT would not write; the message states the object and byte.
    std::optional<RawlogObject> next();

    /// "file: object 12 at byte 3456" of the last object; objects count from 1, bytes from 0.
    std::string where() const;

private:
    std::string_view rest() const { return {block_.data() + first_, last_ - first_}; }
    void fill();
    void drop(std::size_t count);
    std::optional<RawlogHead> head();
    void enter_frame(const RawlogHead& head);
    void leave_frames();
    RawlogObject object_at(const RawlogHead& head);
    std::size_t size_to_next();
    bool closes_frame(std::string_view object) const;
    std::string kind_of_file() const;

    std::unique_ptr<ByteStream> bytes_;
    std::string name_;
    std::vector<char> block_;
    std::size_t first_ = 0; ///< start of the unread bytes in the block
    std::size_t last_ = 0;
    std::size_t taken_ = 0;    ///< size of the last returned object
    std::uint64_t offset_ = 0; ///< position of block_[first_] in the file
    std::size_t number_ = 0;
    std::optional<std::size_t> left_in_frame_;
    bool ended_ = false;
};

} // namespace macadam
