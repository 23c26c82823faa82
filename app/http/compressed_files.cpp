#include "app/http/compressed_files.hpp"

#include "storage/files/gzip.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <unistd.h>

namespace macadam {
namespace {

/// Content of a file, all of one version; `std::nullopt` if it cannot be read so.
std::optional<std::string> content_of(const HttpFile& file) {
    std::string content(file.size, '\0');
    for (std::size_t read = 0; read < content.size();) {
        const auto count = pread(file.open->number(),
                                 content.data() + read,
                                 content.size() - read,
                                 static_cast<off_t>(read));
        if (count <= 0) {
            return std::nullopt;
        }
        read += static_cast<std::size_t>(count);
    }
    return file.open->is_unchanged() ? std::optional{std::move(content)} : std::nullopt;
}

} // namespace

std::shared_ptr<const std::string> CompressedFiles::get(const std::string& name,
                                                        const HttpFile& file) {
    if (auto kept = find(name)) {
        return kept;
    }
    const auto content = file.size > max_file_bytes ? std::nullopt : content_of(file);
    if (!content) {
        return nullptr;
    }
    auto bytes = std::make_shared<const std::string>(gzipped(*content, GzipUse::kept));
    keep(name, bytes);
    return bytes;
}

std::shared_ptr<const std::string> CompressedFiles::find(const std::string& name) {
    const std::lock_guard lock{mutex_};
    const auto found = std::ranges::find(recent_, name, &Kept::name);
    if (found == recent_.end()) {
        return nullptr;
    }
    recent_.splice(recent_.begin(), recent_, found);
    return found->bytes;
}

void CompressedFiles::keep(const std::string& name, std::shared_ptr<const std::string> bytes) {
    const std::lock_guard lock{mutex_};
    if (std::ranges::find(recent_, name, &Kept::name) != recent_.end()) {
        return; // another worker was faster
    }
    bytes_ += bytes->size();
    recent_.push_front({name, std::move(bytes)});
    constexpr std::size_t max_files = 1000;
    while ((bytes_ > max_bytes_ || recent_.size() > max_files) && recent_.size() > 1) {
        bytes_ -= recent_.back().bytes->size();
        recent_.pop_back();
    }
}

} // namespace macadam
