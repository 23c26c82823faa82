#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

inline constexpr std::size_t max_archive_files = 1000;

/// Reads the regular files of a .zip, .tar, .tar.gz or .tar.zst archive in one pass, in the order
/// of the archive. Files may have equal names. Nothing is extracted to disk, so file names need no
/// checks.
///
/// An archive whose total decompressed size exceeds max_expansion (byte_stream.hpp) is refused, and
/// so is every file after the first `max_files`.
class ArchiveFiles {
public:
    /// \throws InputError  if the file cannot be read or is not an archive.
    ArchiveFiles(std::filesystem::path archive, std::size_t max_files);
    ArchiveFiles(const ArchiveFiles&) = delete;
    ArchiveFiles& operator=(const ArchiveFiles&) = delete;
    ~ArchiveFiles();

    /// Name of the next file; `std::nullopt` at the end, or after an error from which reading
    /// cannot continue.
    ///
    /// \throws InputError  if the archive is damaged or exceeds one of its limits.
    std::optional<std::string> next();

    /// Content of the current file, decompressed if the file is itself compressed. Callable once
    /// per file.
    ///
    /// \throws InputError  if the file is damaged or exceeds the limits of byte_stream.hpp.
    std::string content();

    class Bytes;

private:
    void skip();
    void expect_modest();
    [[noreturn]] void fail(const std::string& name);

    struct Reader;
    std::filesystem::path archive_;
    std::uint64_t size_;
    std::unique_ptr<Reader> reader_;
    std::string name_;
    std::size_t max_files_;
    std::size_t files_ = 0;
    std::size_t others_ = 0; ///< folders, links and the like
    std::uint64_t came_ = 0; ///< decompressed bytes of all files so far
    bool ended_ = false;
};

} // namespace macadam
