#pragma once

#include "storage/atomic/atomic_file.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace macadam {

enum class Compression : std::uint8_t { none, gzip, zstd };

/// gzip for a name that ends in .gz, zstd for .zst, otherwise none.
Compression compression_of(const std::filesystem::path& file);

/// An AtomicFile whose content is compressed on its way. The bytes depend on what is written and on
/// the level alone: no time, no name.
///
/// \throws InputError  as AtomicFile does.
class CompressedFile {
public:
    /// \param level  1 (fast) to 9 (small).
    CompressedFile(const std::filesystem::path& file, Compression compression, int level);
    CompressedFile(const CompressedFile&) = delete;
    CompressedFile& operator=(const CompressedFile&) = delete;
    ~CompressedFile();

    void write(std::string_view bytes);
    void commit();

    class Encoder;

private:
    AtomicFile file_;
    std::unique_ptr<Encoder> encoder_; ///< null: none
};

} // namespace macadam
