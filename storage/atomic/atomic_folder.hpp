#pragma once

#include "storage/atomic/temporary_folder.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Tests that a folder can be created or filled.
///
/// \returns true if it exists and is empty, false if it does not exist.
/// \throws InputError  for a folder that is not empty, and for anything that is not a folder.
bool expect_new_or_empty(const std::filesystem::path& folder);

/// Folder that is filled completely or not at all. The content is written to a TemporaryFolder, and
/// commit() moves it into place. Without commit() no file remains. If the program is killed, the
/// temporary folder remains beside the target, or inside it if the target existed before.
///
/// \throws InputError  from every call that fails; the message names the folder and the cause.
class AtomicFolder {
public:
    /// \param folder  a new name, or an empty folder.
    explicit AtomicFolder(std::filesystem::path folder);
    AtomicFolder(const AtomicFolder&) = delete;
    AtomicFolder& operator=(const AtomicFolder&) = delete;

    /// Folder in which to write before commit().
    const std::filesystem::path& temporary() const { return content_; }

    void commit();

private:
    std::filesystem::path folder_;
    bool exists_;
    std::optional<TemporaryFolder> temporary_;
    std::filesystem::path content_;
};

} // namespace macadam
