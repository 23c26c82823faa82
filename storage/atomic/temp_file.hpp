#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace macadam {

/// Position of bytes in a TempFile.
struct ByteRange {
    std::uint64_t at = 0;
    std::uint32_t size = 0;
};

/// Unnamed temporary file on disk, deleted with this object. One thread at a time may append; many
/// may read what was appended.
///
/// \throws InputError  from every call that fails; the message names the file `beside`.
class TempFile {
public:
    /// \param beside  file in the folder that has room, usually the output file.
    explicit TempFile(std::filesystem::path beside);
    TempFile(const TempFile&) = delete;
    TempFile& operator=(const TempFile&) = delete;
    ~TempFile();

    /// \param bytes  fewer than 4 GiB.
    ByteRange append(std::string_view bytes);
    std::string read(const ByteRange& place) const;

    std::uint64_t size() const { return size_; }
    const std::filesystem::path& beside() const { return beside_; }

private:
    std::filesystem::path beside_;
    int descriptor_;
    std::uint64_t size_ = 0;
};

} // namespace macadam
