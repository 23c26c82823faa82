#pragma once

#include "storage/atomic/atomic_file.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace macadam {

enum class Compression : std::uint8_t { none, gzip, zstd };

/// Compression by file suffix: gzip for .gz, zstd for .zst, otherwise none.
Compression compression_of(const std::filesystem::path& file);

/// AtomicFile that compresses its content. The output depends only on the content and the level: it
/// contains no time and no name.
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
    std::unique_ptr<Encoder> encoder_; ///< null without compression
};

} // namespace macadam
