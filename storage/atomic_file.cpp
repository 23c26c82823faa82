#include "storage/atomic_file.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace macadam {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
    throw InputError{fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error))};
}

std::filesystem::path name_beside(const std::filesystem::path& file) {
    auto name = file;
    name += fmt::format(".part-{}", ::getpid());
    return name;
}

/// What the system says of syncing the file or folder of that name: 0 or an errno.
int sync_by_name(const std::filesystem::path& name, int flags) {
    const int descriptor = ::open(name.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0) {
        return errno;
    }
    const int error = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    return error;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path{"."};
}

} // namespace

AtomicFile::AtomicFile(std::filesystem::path file)
    : file_{std::move(file)}, temporary_{name_beside(file_)}, out_{std::fopen(temporary_.c_str(),
                                                                              "wbe")} {
    if (out_ == nullptr) {
        fail(file_, errno);
    }
}

AtomicFile::~AtomicFile() {
    if (out_ != nullptr) {
        std::fclose(out_);
    }
    if (!temporary_.empty()) {
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
    }
}

void AtomicFile::write(std::string_view text) {
    if (text.empty()) { // which may lie nowhere
        return;
    }
    if (std::fwrite(text.data(), 1, text.size(), out_) != text.size()) {
        fail(file_, errno);
    }
}

void AtomicFile::commit() {
    if (std::fflush(out_) != 0) {
        fail(file_, errno);
    }
    if (std::fclose(std::exchange(out_, nullptr)) != 0) {
        fail(file_, errno);
    }
    // By name: a library that wrote it may have put another file in its place.
    if (const int error = sync_by_name(temporary_, O_RDONLY)) {
        fail(file_, error);
    }
    if (std::rename(temporary_.c_str(), file_.c_str()) != 0) {
        fail(file_, errno);
    }
    temporary_.clear();
    if (const int error = sync_by_name(folder_of(file_), O_RDONLY | O_DIRECTORY)) {
        fail(file_, error);
    }
}

} // namespace macadam
