#include "storage/atomic_folder.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_mark = ".part-";

[[noreturn]] void fail(const fs::path& folder, const std::string& cause) {
    throw InputError{fmt::format("{}: cannot be made as a folder: {}", folder.string(), cause)};
}

void require(const std::error_code& error, const fs::path& folder) {
    if (error) {
        fail(folder, error.message());
    }
}

/// "fleet/" as "fleet", so that a name can be made of it.
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

/// \returns whether it is there.
bool expect_new_or_empty(const fs::path& folder) {
    std::error_code none;
    if (!fs::exists(fs::symlink_status(folder, none))) {
        return false;
    }
    if (!fs::is_directory(folder, none)) {
        fail(folder, "a file is in the way");
    }
    const auto entries = entries_of(folder);
    if (entries.size() == 1 &&
        entries.front().filename().string().find(part_mark) != std::string::npos) {
        throw InputError{fmt::format("{}: is left of work that was cut off, expected that nothing "
                                     "else is in the folder: remove it first",
                                     entries.front().string())};
    }
    if (!entries.empty()) {
        throw InputError{
            fmt::format("{}: is not empty, expected a new or an empty folder", folder.string())};
    }
    return true;
}

AtomicFolder::AtomicFolder(fs::path folder)
    : folder_{without_slash(folder)}, exists_{expect_new_or_empty(folder_)} {
    // The parent of a folder that is there may belong to somebody else, or to another disk.
    const auto name =
        fmt::format("{}{}{}", exists_ ? "" : folder_.filename().string(), part_mark, ::getpid());
    temporary_ = (exists_ ? folder_ : folder_.parent_path()) / name;
    std::error_code error;
    fs::create_directories(temporary_, error);
    require(error, folder_);
}

AtomicFolder::~AtomicFolder() {
    std::error_code ignored;
    if (!temporary_.empty()) {
        fs::remove_all(temporary_, ignored);
    }
}

void AtomicFolder::commit() {
    std::error_code error;
    if (!exists_) {
        fs::rename(temporary_, folder_, error);
        require(error, folder_);
    } else {
        for (const auto& entry : entries_of(temporary_)) {
            fs::rename(entry, folder_ / entry.filename(), error);
            require(error, folder_);
        }
        fs::remove(temporary_, error);
    }
    temporary_.clear();
}

} // namespace macadam
