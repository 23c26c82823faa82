#include "storage/atomic/atomic_folder.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& folder, const std::string& cause) {
    throw InputError{fmt::format("{}: cannot create the folder: {}", folder.string(), cause)};
}

void require(const std::error_code& error, const fs::path& folder) {
    if (error) {
        fail(folder, error.message());
    }
}

/// Converts "fleet/" to "fleet", so that a name can be derived from it.
fs::path without_slash(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator{folder, error}) {
        entries.push_back(entry.path());
    }
    require(error, folder);
    std::ranges::sort(entries);
    return entries;
}

} // namespace

/// \returns whether it exists.
bool expect_new_or_empty(const fs::path& folder) {
    std::error_code none;
    if (!fs::exists(fs::symlink_status(folder, none))) {
        return false;
    }
    if (!fs::is_directory(folder, none)) {
        fail(folder, "a file is in the way");
    }
    const auto entries = entries_of(folder);
    if (entries.size() == 1 && is_temporary_name(entries.front())) {
        throw InputError{fmt::format(
            "{}: is {}, expected an empty folder: {}",
            entries.front().string(),
            is_worked_on(entries.front()) ? "in use by another program"
                                          : "left behind by an interrupted run",
            is_worked_on(entries.front()) ? "wait until it has finished" : "remove it first")};
    }
    if (!entries.empty()) {
        throw InputError{
            fmt::format("{}: is not empty, expected a new or an empty folder", folder.string())};
    }
    return true;
}

AtomicFolder::AtomicFolder(fs::path folder)
    : folder_{without_slash(folder)}, exists_{expect_new_or_empty(folder_)} {
    std::error_code error;
    if (folder_.has_parent_path()) {
        fs::create_directories(folder_.parent_path(), error);
        require(error, folder_);
    }
    try {
        // The parent of an existing folder may belong to another user, or be on another disk.
        temporary_.emplace(exists_ ? folder_ / "" : folder_);
    } catch (const std::system_error& failure) {
        fail(folder_, failure.code().message());
    }
    content_ = temporary_->path() / "content"; // with ordinary permissions
    fs::create_directory(content_, error);
    require(error, folder_);
}

void AtomicFolder::commit() {
    std::error_code error;
    if (!exists_) {
        fs::rename(content_, folder_, error);
        require(error, folder_);
        return;
    }
    for (const auto& entry : entries_of(content_)) {
        fs::rename(entry, folder_ / entry.filename(), error);
        require(error, folder_);
    }
}

} // namespace macadam
