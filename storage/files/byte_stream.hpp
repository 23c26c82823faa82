#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace macadam {

/// Sequential, single-pass source of bytes.
class ByteStream {
public:
    ByteStream() = default;
    ByteStream(const ByteStream&) = delete;
    ByteStream& operator=(const ByteStream&) = delete;
    virtual ~ByteStream() = default;

    /// Fills the front of `into`.
    /// \returns the number of bytes; 0 only at the end, or for an empty span.
    ///
    /// \throws InputError  with the name of the file and the cause.
    virtual std::size_t read(std::span<char> into) = 0;

    /// Bytes of the file on disk that were read so far, before decompression.
    virtual std::uint64_t consumed() const = 0;
};

/// Opens a file as a stream.
std::unique_ptr<ByteStream> file_bytes(const std::filesystem::path& file);

/// Opens the standard input as a stream.
std::unique_ptr<ByteStream> standard_input_bytes();

inline constexpr std::uint64_t max_decompressed_bytes = std::uint64_t{1} << 30; // 30 h at 100 Hz
inline constexpr std::uint64_t free_decompressed_bytes = std::uint64_t{16} << 20;
inline constexpr std::uint64_t max_expansion = 100; // trip logs reach 3 to 5

} // namespace macadam
