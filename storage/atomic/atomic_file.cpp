#include "storage/atomic/atomic_file.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace macadam {
namespace {

constexpr const char* name_in_folder = "file";

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
    throw InputError{fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error))};
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path{"."};
}

/// Syncs a folder. \returns 0 or an errno.
int sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        return errno;
    }
    const int error = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    return error;
}

/// Path by which an unnamed file can be linked to a name.
std::string way_to(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

/// \returns 0 or an errno.
int link_to(int descriptor, const std::filesystem::path& name) {
    return ::linkat(
               AT_FDCWD, way_to(descriptor).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0
               ? 0
               : errno;
}

/// Renames a file unless the new name exists. \returns 0 or an errno.
int rename_to_free(const std::filesystem::path& from, const std::filesystem::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) {
        return 0;
    }
    // Not every file system has this flag; those without have links.
    return errno == EINVAL && ::link(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// Opens an unnamed file; -1 if they are unsupported, or cannot be linked to a name later.
int nameless_file(const std::filesystem::path& folder, unsigned permissions) {
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, permissions);
    if (descriptor >= 0 && ::access(way_to(descriptor).c_str(), F_OK) != 0) {
        ::close(descriptor);
        return -1;
    }
    return descriptor;
}

} // namespace

AtomicFile::AtomicFile(std::filesystem::path file, unsigned permissions) : file_{std::move(file)} {
    const int descriptor = opened(permissions);
    if (descriptor >= 0) {
        out_ = ::fdopen(descriptor, "wb");
    }
    if (out_ == nullptr) {
        fail(file_, errno);
    }
}

AtomicFile::~AtomicFile() {
    if (out_ != nullptr) {
        std::fclose(out_);
    }
}

int AtomicFile::opened(unsigned permissions) {
    const int descriptor = nameless_file(folder_of(file_), permissions);
    if (descriptor >= 0) {
        return descriptor;
    }
    try {
        folder_.emplace(file_);
    } catch (const std::system_error& error) {
        fail(file_, error.code().value());
    }
    return ::open((folder_->path() / name_in_folder).c_str(),
                  O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC,
                  permissions);
}

void AtomicFile::write(std::string_view text) {
    if (text.empty()) { // its data may be null
        return;
    }
    if (std::fwrite(text.data(), 1, text.size(), out_) != text.size()) {
        fail(file_, errno);
    }
}

/// Replaces an existing file by renaming, because a link cannot replace one.
void AtomicFile::put_in_place() {
    if (folder_) {
        const auto whole = folder_->path() / name_in_folder;
        if (std::rename(whole.c_str(), file_.c_str()) != 0) {
            fail(file_, errno);
        }
        return;
    }
    const int descriptor = ::fileno(out_);
    int error = link_to(descriptor, file_);
    if (error == EEXIST) {
        ::flock(descriptor, LOCK_SH | LOCK_NB); // marks it as in use
        const auto name = temporary_name(file_);
        const RemovedIfCutOff removed{name};
        error = link_to(descriptor, name);
        if (error == 0 && std::rename(name.c_str(), file_.c_str()) != 0) {
            error = errno;
            ::unlink(name.c_str());
        }
    }
    if (error != 0) {
        fail(file_, error);
    }
}

void AtomicFile::put_in_free_place() {
    const int error = folder_ ? rename_to_free(folder_->path() / name_in_folder, file_)
                              : link_to(::fileno(out_), file_);
    if (error != 0) {
        fail(file_, error);
    }
}

void AtomicFile::sync() {
    if (std::fflush(out_) != 0 || ::fsync(::fileno(out_)) != 0) {
        fail(file_, errno);
    }
}

void AtomicFile::close() {
    if (std::fclose(std::exchange(out_, nullptr)) != 0) {
        fail(file_, errno);
    }
    if (const int error = sync_folder(folder_of(file_))) {
        fail(file_, error);
    }
}

void AtomicFile::commit() {
    sync();
    put_in_place();
    close();
}

void AtomicFile::commit_new() {
    sync();
    put_in_free_place();
    try {
        close();
    } catch (const InputError&) {
        ::unlink(file_.c_str());
        throw;
    }
}

} // namespace macadam
