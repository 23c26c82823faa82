#pragma once

#include "storage/atomic/temporary_folder.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>

namespace macadam {

/// A file that appears when it is whole, or not at all: written into a file without a name in the
/// same folder, synced, then put in its place. Without commit() nothing is left, whatever becomes
/// of the program. Where the file system has no files without a name, it is one in a
/// TemporaryFolder. For libraries that write by name: AtomicFileSet.
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
    std::optional<TemporaryFolder> folder_; ///< where it cannot be without a name
    std::FILE* out_ = nullptr;
};

} // namespace macadam
