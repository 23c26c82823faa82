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
    explicit AtomicFile(std::filesystem::path file);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void write(std::string_view text);
    void commit();

private:
    int opened();
    void put_in_place();

    std::filesystem::path file_;
    std::optional<TemporaryFolder> folder_; ///< used where the file system has no unnamed files
    std::FILE* out_ = nullptr;
};

} // namespace macadam
