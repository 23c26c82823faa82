#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace macadam {

/// Where bytes lie in a Spool.
struct ByteRange {
    std::uint64_t at = 0;
    std::uint32_t size = 0;
};

/// Bytes laid aside on disk while work goes on, in a file without a name that goes with this
/// object. One thread appends at a time; what is there can be read by many.
///
/// \throws InputError  from every call that fails; the message names the file that the work is for.
class TempFile {
public:
    /// \param beside  a file in the folder that has room, most often the one that is made.
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
