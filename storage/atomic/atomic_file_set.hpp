#pragma once

#include "storage/atomic/temporary_folder.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Set of files in one folder that appear all together or not at all. They are written to a
/// TemporaryFolder beside the target, and commit() moves them to their final names. Without
/// commit() nothing remains. If the program is killed during the move, the temporary folder holds
/// the files not moved yet and the replaced ones. A single file replaces an existing one
/// atomically. Also for a single file that a library writes by name.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class AtomicFileSet {
public:
    /// \param main_file  file that the user named; the others are created beside it.
    explicit AtomicFileSet(std::filesystem::path main_file);
    AtomicFileSet(const AtomicFileSet&) = delete;
    AtomicFileSet& operator=(const AtomicFileSet&) = delete;
    /// Folder in which to write the files, each under its final name.
    const std::filesystem::path& folder() const { return folder_->path(); }

    /// Path at which to write the file that the user named.
    std::filesystem::path main_file() const { return folder() / main_file_.filename(); }

    /// Moves the files to their final names; on failure, replaced files are restored. Programs that
    /// write the same set take turns, so that all files come from one of them.
    ///
    /// \param stale  names of existing files, such as an index, that the new files make invalid;
    ///               they are removed.
    void commit(const std::vector<std::string>& stale = {});

    /// Commits a set of a single file that must not replace an existing one.
    void commit_new();

private:
    std::filesystem::path main_file_;
    std::optional<TemporaryFolder> folder_;
};

} // namespace macadam
