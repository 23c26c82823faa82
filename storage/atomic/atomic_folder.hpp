#pragma once

#include "storage/atomic/temporary_folder.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Whether a folder is there, and empty; false: nothing is.
///
/// \throws InputError  for a folder with something in it, and for what is no folder.
bool expect_new_or_empty(const std::filesystem::path& folder);

/// A folder that is filled when all of it is there, or not at all: work goes on in a
/// TemporaryFolder, whose content commit() moves into place. Without commit() nothing is left. If
/// the program is killed, that folder lies beside the place, or in it if the place was there
/// before.
///
/// \throws InputError  from every call that fails; the message names the folder and the cause.
class AtomicFolder {
public:
    /// \param folder  a new name, or an empty folder.
    explicit AtomicFolder(std::filesystem::path folder);
    AtomicFolder(const AtomicFolder&) = delete;
    AtomicFolder& operator=(const AtomicFolder&) = delete;

    /// Where to work before commit().
    const std::filesystem::path& temporary() const { return content_; }

    void commit();

private:
    std::filesystem::path folder_;
    bool exists_;
    std::optional<TemporaryFolder> temporary_;
    std::filesystem::path content_;
};

} // namespace macadam
