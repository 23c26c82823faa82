#pragma once

#include "storage/atomic/temporary_folder.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Files of one folder that belong together and appear when all of them are whole, or none of them:
/// written into a TemporaryFolder beside their places, which commit() empties. Without commit()
/// nothing is left. If the program is killed while it moves them, that folder holds what is not in
/// its place yet, and what was there before. A file that is alone takes the place of another at
/// once. Also for a single file that a library writes by name.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class AtomicFileSet {
public:
    /// \param main_file  the one that the user named; the others stand beside it.
    explicit AtomicFileSet(std::filesystem::path main_file);
    AtomicFileSet(const AtomicFileSet&) = delete;
    AtomicFileSet& operator=(const AtomicFileSet&) = delete;
    /// Where to write them, each under the name that it will have.
    const std::filesystem::path& folder() const { return folder_->path(); }

    /// The same for the file that the user named.
    std::filesystem::path main_file() const { return folder() / main_file_.filename(); }

    /// Moves them to their places; where that fails, those that were there stand there again. Two
    /// programs that make the same files take turns, so that the files of one of them stand there.
    ///
    /// \param stale  names of files beside them that the new ones make wrong (an index): removed.
    void commit(const std::vector<std::string>& stale = {});

    /// The same for a file that is alone and must not take the place of another.
    void commit_new();

private:
    std::filesystem::path main_file_;
    std::optional<TemporaryFolder> folder_;
};

} // namespace macadam
