#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

inline constexpr std::size_t max_archive_files = 1000;

/// The regular files of a .zip, .tar, .tar.gz or .tar.zst archive, one after the other, each read
/// where it stands: in one pass, and two files of one name are two. Nothing is written to disk, so
/// a file's name can be anything.
///
/// An archive that as a whole grows beyond max_expansion when it is decompressed (byte_stream.hpp)
/// is refused, and so is what follows its first `max_files` files.
class ArchiveFiles {
public:
    /// \throws InputError  if it cannot be read or is no archive.
    ArchiveFiles(std::filesystem::path archive, std::size_t max_files);
    ArchiveFiles(const ArchiveFiles&) = delete;
    ArchiveFiles& operator=(const ArchiveFiles&) = delete;
    ~ArchiveFiles();

    /// The name of the next file; nothing at the end, or after an error that leaves no way on.
    ///
    /// \throws InputError  if the archive is damaged or one of its limits is reached.
    std::optional<std::string> next();

    /// What the file at hand holds, decompressed if it is itself compressed. Once.
    ///
    /// \throws InputError  if it is damaged or beyond the limits of byte_stream.hpp.
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
    std::uint64_t came_ = 0; ///< out of files, decompressed
    bool ended_ = false;
};

} // namespace macadam
