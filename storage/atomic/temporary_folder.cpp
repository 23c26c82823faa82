#include "storage/atomic/temporary_folder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = ".part-";

[[noreturn]] void fail() {
    throw std::system_error{errno, std::generic_category()};
}

std::string random_characters() {
    constexpr std::string_view alphabet = "0123456789abcdefghjkmnpqrstvwxyz"; // 5 bits each
    std::array<unsigned char, 12> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        fail();
    }
    std::string text;
    for (const auto byte : bytes) {
        text += alphabet[byte % alphabet.size()];
    }
    return text;
}

/// Common prefix of all temporary names of a file; short enough for every file system.
std::string begin_of_names(const fs::path& made) {
    constexpr std::size_t max_bytes = 200;
    return made.filename().string().substr(0, max_bytes) + std::string{mark};
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path{"."};
}

fs::path made_folder(const fs::path& beside) {
    for (;;) {
        auto name = temporary_name(beside);
        if (::mkdir(name.c_str(), 0700) == 0) { // follows no link and fails if the name exists
            return name;
        }
        if (errno != EEXIST) {
            fail();
        }
    }
}

/// Locks the folder; file systems without locks are tolerated.
int locked(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) {
        const int error = errno;
        ::rmdir(folder.c_str());
        errno = error;
        fail();
    }
    ::flock(descriptor, LOCK_SH | LOCK_NB);
    return descriptor;
}

std::uintmax_t bytes_of(const fs::path& name) {
    std::error_code none;
    std::uintmax_t bytes = 0;
    if (!fs::is_directory(fs::symlink_status(name, none))) {
        bytes = fs::file_size(name, none);
        return none ? 0 : bytes;
    }
    for (fs::recursive_directory_iterator entry{name, none};
         entry != fs::recursive_directory_iterator{};
         entry.increment(none)) {
        std::error_code unknown;
        if (entry->is_regular_file(unknown)) {
            bytes += entry->file_size(unknown);
        }
    }
    return bytes;
}

void add_leftovers(std::vector<Leftover>& found, const fs::path& folder, const std::string& begin) {
    std::error_code none;
    for (fs::directory_iterator entry{folder, none}; entry != fs::directory_iterator{};
         entry.increment(none)) {
        const auto& name = entry->path();
        if (name.filename().string().starts_with(begin) && is_temporary_name(name) &&
            !is_worked_on(name)) {
            found.push_back({folder == "." ? name.filename() : name, bytes_of(name)});
        }
    }
}

} // namespace

TemporaryFolder::TemporaryFolder(const fs::path& beside)
    : path_{made_folder(beside)}, lock_{locked(path_)}, removed_{path_} {}

TemporaryFolder::~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
    ::close(lock_);
    if (error) {
        fs::remove_all(path_, error); // its last descriptor was that of the lock
    }
}

fs::path temporary_name(const fs::path& beside) {
    return beside.parent_path() / (begin_of_names(beside) + random_characters());
}

std::vector<Leftover> leftovers_of(const fs::path& made) {
    const auto name = made.has_filename() ? made : made.parent_path();
    std::vector<Leftover> found;
    add_leftovers(found, folder_of(name), begin_of_names(name));
    std::error_code none;
    if (fs::is_directory(name, none)) {
        add_leftovers(found, name, std::string{mark});
    }
    std::ranges::sort(found, {}, &Leftover::name);
    return found;
}

void remove_old_leftovers_of(const fs::path& made) {
    constexpr std::time_t least_age_s = 60;
    // Beside it alone: a folder of this name may be a link of another user to one of ours.
    std::vector<Leftover> found;
    add_leftovers(found, folder_of(made), begin_of_names(made));
    for (const auto& leftover : found) {
        struct stat status {};
        if (::lstat(leftover.name.c_str(), &status) == 0 && status.st_uid == ::geteuid() &&
            std::time(nullptr) - status.st_mtime >= least_age_s) {
            std::error_code stays;
            fs::remove_all(leftover.name, stays);
        }
    }
}

bool is_temporary_name(const fs::path& name) {
    return name.filename().string().find(mark) != std::string::npos;
}

bool is_worked_on(const fs::path& temporary) {
    const int descriptor =
        ::open(temporary.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        return true;
    }
    const bool is_free = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    ::close(descriptor);
    return !is_free;
}

} // namespace macadam
