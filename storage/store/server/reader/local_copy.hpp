#pragma once

#include "estimator/common/progress.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/records/publication.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Database as a file, for code that opens it by name many times: the file itself, or for a
/// database on a server a name that leads to its kept copy (server_mirror.hpp).
class LocalCopy {
public:
    /// Brings the copy up to date.
    /// \param audience  operator_: of a crowd, all, if this user has the key; else publications
    /// alone \throws InputError  if the server cannot be reached, or has no such database.
    LocalCopy(std::filesystem::path store,
              LockWaitPolicy wait_policy,
              const Progress& progress,
              Audience audience = Audience::anyone);

    /// The file; of a copy, a link in a folder that goes with this object.
    const std::filesystem::path& file() const { return file_; }

    bool is_of_server() const { return folder_.has_value(); }

    /// Brings the copy up to date again. The name may then lead to another file.
    void refresh(const Progress& progress);

private:
    std::filesystem::path store_;
    LockWaitPolicy wait_policy_;
    Audience audience_;
    std::optional<TemporaryFolder> folder_;
    std::filesystem::path file_;
};

/// Name of a database for titles: of its file, or on its server.
std::string title_of(const std::filesystem::path& store);

} // namespace macadam
