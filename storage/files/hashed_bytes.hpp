#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/files/sha256.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <span>
#include <string>

namespace macadam {

/// Bytes that are hashed as they are read, so that content is identified and parsed in one pass.
class HashedBytes final : public ByteStream {
public:
    explicit HashedBytes(std::unique_ptr<ByteStream> from);

    std::size_t read(std::span<char> into) override;
    std::uint64_t consumed() const override { return from_->consumed(); }

    /// Reads ahead into memory, and hands the bytes out again later.
    /// \returns true if the end was reached within `max_bytes`, so that the hash is known.
    ///
    /// \throws InputError  as the stream does.
    bool read_ahead(std::size_t max_bytes);

    /// Reads to the end, and returns the SHA-256 of all bytes: 64 lower-case hex digits.
    ///
    /// \throws InputError  if the bytes cannot be read, also if an earlier reader met that.
    std::string sha256();

private:
    std::size_t fetch(std::span<char> into);

    std::unique_ptr<ByteStream> from_;
    Sha256 hash_;
    std::deque<std::string> ahead_; ///< blocks, none empty; each is freed once it was handed out
    std::size_t at_ = 0;            ///< next byte of the first of them
    bool ended_ = false;
    std::exception_ptr failure_; ///< ended the bytes early
    std::string sha256_;         ///< once it was asked for
};

} // namespace macadam
