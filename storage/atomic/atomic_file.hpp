#pragma once

#include "storage/atomic/temporary_folder.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>

namespace macadam {

/// File that appears complete or not at all. It is written to an unnamed file in the same folder,
/// synced, then linked under its name by commit(). Without commit() no file remains, even if the
/// program is killed. On file systems without unnamed files, it is written in a TemporaryFolder.
/// For libraries that write by name, use AtomicFileSet.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class AtomicFile {
public:
    /// \param permissions  reduced by the umask.
    explicit AtomicFile(std::filesystem::path file, unsigned permissions = 0666);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void write(std::string_view text);
    void commit();

    /// Commits, but fails if a file of this name exists; after any failure none is left.
    void commit_new();

private:
    int opened(unsigned permissions);
    void sync();
    void put_in_place();
    void put_in_free_place();
    void close();

    std::filesystem::path file_;
    std::optional<TemporaryFolder> folder_; ///< used where the file system has no unnamed files
    std::FILE* out_ = nullptr;
};

} // namespace macadam
