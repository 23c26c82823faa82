#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Files of one folder that belong together and appear when all of them are whole, or none of them:
/// written into a folder `NAME.part-PID` beside their places, which commit() empties. Without
/// commit() nothing is left. If the program is killed while it moves them, that folder holds what
/// is not in its place yet, and what was there before.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class AtomicFileSet {
public:
    /// \param main_file  the one that the user named; the others stand beside it.
    explicit AtomicFileSet(std::filesystem::path main_file);
    AtomicFileSet(const AtomicFileSet&) = delete;
    AtomicFileSet& operator=(const AtomicFileSet&) = delete;
    ~AtomicFileSet();

    /// Where to write them, each under the name that it will have.
    const std::filesystem::path& folder() const { return folder_; }

    /// Moves them to their places; where that fails, those that were there stand there again.
    ///
    /// \param stale  names of files beside them that the new ones make wrong (an index): removed.
    void commit(const std::vector<std::string>& stale = {});

private:
    std::filesystem::path main_file_;
    std::filesystem::path folder_;
};

} // namespace macadam
