#include "storage/atomic/temp_file.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

namespace macadam {
namespace {

[[noreturn]] void fail(const std::filesystem::path& beside, const char* deed, int error) {
    throw InputError{
        fmt::format("{}: cannot be {}: {}", beside.string(), deed, std::strerror(error))};
}

/// Opens an unnamed file, which not every file system supports.
int nameless_file(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) {
        return descriptor;
    }
    auto name = (folder / ".macadam-XXXXXX").string();
    const int named = ::mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) {
        ::unlink(name.c_str());
    }
    return named;
}

} // namespace

TempFile::TempFile(std::filesystem::path beside) : beside_{std::move(beside)} {
    const auto folder = beside_.has_parent_path() ? beside_.parent_path() : ".";
    descriptor_ = nameless_file(folder);
    if (descriptor_ < 0) {
        fail(beside_, "written", errno);
    }
}

TempFile::~TempFile() {
    ::close(descriptor_);
}

ByteRange TempFile::append(std::string_view bytes) {
    assert(bytes.size() <= std::numeric_limits<std::uint32_t>::max());
    const ByteRange place{size_, static_cast<std::uint32_t>(bytes.size())};
    while (!bytes.empty()) {
        const auto written =
            ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
        if (written < 0 && errno != EINTR) {
            fail(beside_, "written", errno);
        }
        if (written > 0) {
            size_ += static_cast<std::uint64_t>(written);
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }
    return place;
}

std::string TempFile::read(const ByteRange& place) const {
    std::string bytes(place.size, '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
        const auto got = ::pread(descriptor_,
                                 bytes.data() + done,
                                 bytes.size() - done,
                                 static_cast<off_t>(place.at + done));
        if (got == 0 || (got < 0 && errno != EINTR)) {
            fail(beside_, "written: the temporary data cannot be read", got == 0 ? EIO : errno);
        }
        done += got > 0 ? static_cast<std::size_t>(got) : 0;
    }
    return bytes;
}

} // namespace macadam
