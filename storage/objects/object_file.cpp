#include "storage/objects/object_file.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace macadam {
namespace {

constexpr unsigned readable_by_owner = 0600; // logs tell where people drive

[[noreturn]] void fail(const std::filesystem::path& file) {
    throw InputError{fmt::format("{}: {}", file.string(), std::strerror(errno))};
}

} // namespace

std::size_t ObjectSource::read(std::span<char> into) {
    const auto count = from_->read(into);
    hash_.add({into.data(), count});
    bytes_ += static_cast<std::int64_t>(count);
    return count;
}

void ObjectSource::expect(const LogObject& object, const std::filesystem::path& file) {
    if (sha256_.empty()) {
        sha256_ = hash_.hex();
    }
    if (bytes_ != object.bytes || sha256_ != object.sha256) {
        throw InputError{
            fmt::format("{}: changed while it was stored; run the command again", file.string())};
    }
}

FetchedFile::FetchedFile(LogObject object, std::filesystem::path file)
    : object_{std::move(object)}, file_{std::move(file)} {
    const int descriptor = ::open(
        file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, readable_by_owner);
    out_ = descriptor >= 0 ? ::fdopen(descriptor, "wb") : nullptr;
    if (out_ == nullptr) {
        fail(file_);
    }
}

FetchedFile::~FetchedFile() {
    if (out_ != nullptr) {
        std::fclose(out_);
    }
    if (!is_kept_) {
        ::unlink(file_.c_str());
    }
}

bool FetchedFile::add(std::string_view bytes) {
    bytes_ += static_cast<std::int64_t>(bytes.size());
    if (bytes_ > object_.bytes) {
        return false;
    }
    hash_.add(bytes);
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), out_) != bytes.size()) {
        fail(file_);
    }
    return true;
}

void FetchedFile::keep(const std::string& store) {
    if (bytes_ != object_.bytes || hash_.hex() != object_.sha256) {
        throw UnusableObject{fmt::format(
            "{}: object {} is damaged: its bytes have another SHA-256", store, object_.sha256)};
    }
    if (std::fclose(std::exchange(out_, nullptr)) != 0) {
        fail(file_);
    }
    is_kept_ = true;
}

} // namespace macadam
