#include "storage/store/connection/import_lock.hpp"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Lock file of a database, also if it is known by a symbolic link.
fs::path lock_file_of(const fs::path& store) {
    std::error_code ignored;
    auto file = fs::weakly_canonical(store, ignored);
    file = file.empty() ? store : file;
    file += "-import";
    return file;
}

/// Byte that stands for an import: FNV-1a of its name, 62 bits.
off_t byte_of(const std::string& import) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : import) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
    return static_cast<off_t>(hash >> 2);
}

/// Returns a lock of one byte, or of all (length 0).
struct flock lock_of(short type, off_t first, off_t length) {
    struct flock lock {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = first;
    lock.l_len = length;
    return lock;
}

bool take(int descriptor, struct flock lock) {
    return ::fcntl(descriptor, F_OFD_SETLK, &lock) == 0;
}

/// Tests whether another open file holds a lock on the byte of an import, or on any.
bool is_locked(int descriptor, const std::optional<std::string>& import) {
    auto lock = import ? lock_of(F_WRLCK, byte_of(*import), 1) : lock_of(F_WRLCK, 0, 0);
    return ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

/// Opens or creates the lock file. That of another user may be readable only, which suffices for
/// the lock of an import.
int open_lock_file(const fs::path& file) {
    constexpr mode_t for_all = 0666; // less the umask: readers of the database ask
    const int descriptor =
        ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, for_all);
    return descriptor < 0 && errno == EACCES
               ? ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)
               : descriptor;
}

/// Tests whether the open file still has its name, which another import may have removed.
bool is_in_place(int descriptor, const fs::path& file) {
    struct stat open {};
    struct stat named {};
    return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 &&
           open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

} // namespace

ImportLock::ImportLock(const fs::path& store, const std::string& import)
    : file_{lock_file_of(store)} {
    constexpr int max_tries = 100; // each lost to an import that removes the file meanwhile
    constexpr std::chrono::milliseconds pause{1};
    for (int i = 0; i < max_tries; ++i) {
        descriptor_ = open_lock_file(file_);
        if (descriptor_ < 0) {
            return;
        }
        const bool is_taken = take(descriptor_, lock_of(F_RDLCK, byte_of(import), 1));
        const bool is_held_by_other = !is_taken && (errno == EAGAIN || errno == EACCES);
        if (is_taken && is_in_place(descriptor_, file_)) {
            return;
        }
        ::close(descriptor_);
        descriptor_ = -1;
        if (!is_taken && !is_held_by_other) {
            return; // a file system without locks
        }
        std::this_thread::sleep_for(pause);
    }
}

ImportLock::~ImportLock() {
    if (descriptor_ < 0) {
        return;
    }
    // Only the last import gets the lock on all bytes, and removes the file.
    if (take(descriptor_, lock_of(F_WRLCK, 0, 0)) && is_in_place(descriptor_, file_)) {
        ::unlink(file_.c_str());
    }
    ::close(descriptor_);
}

bool ImportLock::is_other_running(const std::optional<std::string>& import) const {
    return descriptor_ >= 0 && is_locked(descriptor_, import);
}

bool is_import_running(const fs::path& store, const std::optional<std::string>& import) {
    const int descriptor =
        ::open(lock_file_of(store).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) {
        return false;
    }
    const bool is_running = is_locked(descriptor, import);
    ::close(descriptor);
    return is_running;
}

} // namespace macadam
