#pragma once

#include "storage/atomic/unfinished_files.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Private working folder (mode 0700) named `NAME.part-` and twelve random characters, which others
/// can neither predict nor enter. It is removed with its content when this object is destroyed or
/// when a signal ends the program. It remains only if the program is killed; see leftovers_of().
class TemporaryFolder {
public:
    /// \param beside  file or folder NAME that is being made; the folder is created beside it.
    /// \throws std::system_error  if the folder cannot be created.
    explicit TemporaryFolder(const std::filesystem::path& beside);
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::filesystem::path& path() const { return path_; }

    /// Keeps the folder when a signal ends the program, because it now holds data that must not be
    /// lost; only this object removes it.
    void keep_if_cut_off() { removed_.release(); }

private:
    std::filesystem::path path_;
    int lock_; ///< tells other programs that the owner is alive
    RemovedIfCutOff removed_;
};

/// Unused name beside a file: `NAME.part-` and twelve random characters.
/// \throws std::system_error  if the system provides no random numbers.
std::filesystem::path temporary_name(const std::filesystem::path& beside);

/// Unfinished file or folder of a program that was killed.
struct Leftover {
    std::filesystem::path name;
    std::uintmax_t bytes;
};

/// Lists what killed programs left beside and inside the file or folder `made`, in the order of
/// names. Files that running programs still use are not included.
std::vector<Leftover> leftovers_of(const std::filesystem::path& made);

/// Removes what killed programs of this user left beside `made`, except what is younger
/// than a minute: its program may be about to mark it as in use. What cannot be removed stays.
void remove_old_leftovers_of(const std::filesystem::path& made);

/// Tests whether a name is that of an unfinished file or folder.
bool is_temporary_name(const std::filesystem::path& name);

/// Tests whether a running program uses the unfinished file or folder; true if that cannot be
/// determined.
bool is_worked_on(const std::filesystem::path& temporary);

} // namespace macadam
