#pragma once

#include "storage/atomic/unfinished_files.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// A folder to work in that nobody else can foresee or enter (mode 0700), named `NAME.part-` and
/// twelve random characters. It goes with this object, with all that is in it, and also where the
/// program is cut off by a signal. Only a program that is killed leaves it; see leftovers_of().
class TemporaryFolder {
public:
    /// \param beside  the file or folder that is made, NAME: it stands beside that.
    /// \throws std::system_error  if it cannot be made.
    explicit TemporaryFolder(const std::filesystem::path& beside);
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::filesystem::path& path() const { return path_; }

    /// From now on it holds what must not be lost, and is only removed by this object.
    void keep_if_cut_off() { removed_.release(); }

private:
    std::filesystem::path path_;
    int lock_; ///< tells other programs that its owner lives
    RemovedIfCutOff removed_;
};

/// A name beside a file that nobody has: `NAME.part-` and twelve random characters.
/// \throws std::system_error  if the system gives no random numbers.
std::filesystem::path temporary_name(const std::filesystem::path& beside);

/// An unfinished file or folder whose maker was killed.
struct Leftover {
    std::filesystem::path name;
    std::uintmax_t bytes;
};

/// What killed programs that made this file or folder left beside it, and in it; in the order of
/// names. What living programs work on is not among them.
std::vector<Leftover> leftovers_of(const std::filesystem::path& made);

/// Whether a name is that of an unfinished file or folder.
bool is_temporary_name(const std::filesystem::path& name);

/// Whether a program that lives works on it; also where that cannot be told.
bool is_worked_on(const std::filesystem::path& temporary);

} // namespace macadam
