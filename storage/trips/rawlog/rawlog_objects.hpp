#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/files/sha256.hpp"
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
    RawlogClass kind; ///< never frame; other, too, for messages of receivers that are not read
    std::string name; ///< of its class
    std::string_view bytes;
};

/// The objects of a rawlog one after the other; those in a frame (CSensoryFrame) one by one, too.
/// Objects of classes that are not read end where the next one begins.
class RawlogObjects {
public:
    /// \param bytes  decompressed.
    /// \param name   of the file, for messages.
    RawlogObjects(std::unique_ptr<ByteStream> bytes, std::string name);

    /// Good until the next call. Nothing at the end.
    ///
    /// \throws InputError  if the file is of another kind, is cut off, or holds what MRPT would
    ///                     not write; the message says at which object and byte.
    std::optional<RawlogObject> next();

    /// "file: object 12 at byte 3456" of the last object, both counted from where they begin: 1, 0.
    std::string where() const;

    std::uint64_t consumed() const { return bytes_->consumed(); }

    /// Of everything, once the last object was read.
    std::string sha256() { return sha256_.hex(); }

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
    Sha256 sha256_;
    std::vector<char> block_;
    std::size_t first_ = 0; ///< of the bytes in the block that were not handed out
    std::size_t last_ = 0;
    std::size_t taken_ = 0;    ///< bytes of the object that was handed out last
    std::uint64_t offset_ = 0; ///< of block_[first_] in the file
    std::size_t number_ = 0;
    std::optional<std::size_t> left_in_frame_;
    bool ended_ = false;
};

} // namespace macadam
