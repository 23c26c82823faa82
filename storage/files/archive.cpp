#include "storage/files/archive.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/decompress.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

namespace macadam {

struct ArchiveFiles::Reader {
    struct Free {
        void operator()(archive* reader) const { archive_read_free(reader); }
    };
    std::unique_ptr<archive, Free> handle{archive_read_new()};

    bool is_zip() const {
        return (archive_format(handle.get()) & ARCHIVE_FORMAT_BASE_MASK) == ARCHIVE_FORMAT_ZIP;
    }

    /// Position in the file on disk.
    std::uint64_t position() const {
        return static_cast<std::uint64_t>(
            std::max<la_int64_t>(0, archive_filter_bytes(handle.get(), -1)));
    }

    /// Bytes of the archive after removing its own compression.
    std::uint64_t unpacked() const {
        return static_cast<std::uint64_t>(
            std::max<la_int64_t>(0, archive_filter_bytes(handle.get(), 0)));
    }
};

namespace {

constexpr std::size_t input_block = 64 << 10;

std::string name_of(archive_entry* entry) {
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr) { // not representable in this locale
        name = archive_entry_pathname_utf8(entry);
    }
    return name != nullptr ? name : "";
}

InputError expands(const std::string& name) {
    return InputError{fmt::format("{}: grows more than {}-fold when decompressed, which no "
                                  "trip log does",
                                  name,
                                  max_expansion)};
}

} // namespace

/// Current file as stored in the archive.
class ArchiveFiles::Bytes final : public ByteStream {
public:
    explicit Bytes(ArchiveFiles& from) : from_{from}, before_{from.reader_->position()} {}

    std::size_t read(std::span<char> into) override {
        const auto count = archive_read_data(from_.reader_->handle.get(), into.data(), into.size());
        if (count < 0) {
            from_.ended_ = count == ARCHIVE_FATAL;
            from_.fail(from_.archive_.string() + "/" + from_.name_);
        }
        from_.expect_modest();
        return static_cast<std::size_t>(count);
    }

    // The block with the file's header was read before.
    std::uint64_t consumed() const override {
        const auto now = from_.reader_->position();
        return (now > before_ ? now - before_ : 0) + std::min<std::uint64_t>(before_, input_block);
    }

private:
    ArchiveFiles& from_;
    std::uint64_t before_;
};

ArchiveFiles::ArchiveFiles(std::filesystem::path archive, std::size_t max_files)
    : archive_{std::move(archive)}, size_{0}, reader_{std::make_unique<Reader>()}, max_files_{
                                                                                       max_files} {
    auto* const reader = reader_->handle.get();
    archive_read_support_format_zip(reader);
    archive_read_support_format_tar(reader);
    archive_read_support_filter_gzip(reader);
    archive_read_support_filter_zstd(reader);
    std::error_code unknown;
    size_ = std::filesystem::file_size(archive_, unknown);
    if (archive_read_open_filename(reader, archive_.c_str(), input_block) != ARCHIVE_OK) {
        if (std::ifstream{archive_}) { // it exists, but is not an archive
            fail(archive_.string());
        }
        const char* const cause = archive_error_string(reader);
        throw InputError{fmt::format("{}: cannot be read{}{}",
                                     archive_.string(),
                                     cause != nullptr ? ": " : "",
                                     cause != nullptr ? cause : "")};
    }
}

ArchiveFiles::~ArchiveFiles() = default;

void ArchiveFiles::fail(const std::string& name) {
    const char* const cause = archive_error_string(reader_->handle.get());
    throw InputError{fmt::format("{}: the archive is truncated or damaged: {}",
                                 name,
                                 cause != nullptr ? cause : "its structure is broken")};
}

/// Checks the expansion of the whole archive: files may overlap in it, so that their total is
/// larger than each of them; bytes read twice count once.
void ArchiveFiles::expect_modest() {
    const auto out = std::max(came_, reader_->unpacked());
    const auto in = std::min(reader_->position(), size_);
    if (out > free_decompressed_bytes && out > max_expansion * in) {
        ended_ = true;
        throw expands(archive_.string());
    }
}

/// Skips the rest of the current file. In a .zip it is not decompressed, in a .tar.gz it must be.
void ArchiveFiles::skip() {
    const void* block = nullptr;
    std::size_t size = 0;
    la_int64_t at = 0;
    while (!reader_->is_zip() &&
           archive_read_data_block(reader_->handle.get(), &block, &size, &at) == ARCHIVE_OK) {
        expect_modest();
    }
}

std::optional<std::string> ArchiveFiles::next() {
    if (files_ > 0 && !ended_) {
        skip();
    }
    while (!ended_) {
        archive_entry* entry = nullptr;
        const auto result = archive_read_next_header(reader_->handle.get(), &entry);
        if (result == ARCHIVE_EOF) {
            ended_ = true;
            break;
        }
        if (result != ARCHIVE_OK && result != ARCHIVE_WARN) {
            ended_ = true;
            fail(archive_.string());
        }
        expect_modest();
        const bool is_file = archive_entry_filetype(entry) == AE_IFREG;
        auto& count = is_file ? files_ : others_;
        if (++count > max_files_) {
            ended_ = true;
            throw InputError{
                fmt::format("{}: contains more than {} {}; --max-members N raises the limit",
                            archive_.string(),
                            max_files_,
                            is_file ? "files" : "folders and links")};
        }
        if (is_file) {
            name_ = name_of(entry);
            return name_;
        }
    }
    return std::nullopt;
}

std::string ArchiveFiles::content() {
    constexpr std::size_t block = 256 << 10;
    const auto name = archive_.string() + "/" + name_;
    const auto bytes = decompressed(bounded(std::make_unique<Bytes>(*this), name), name);
    std::string content;
    for (;;) {
        const auto size = content.size();
        content.resize(size + block);
        const auto count = bytes->read({content.data() + size, block});
        content.resize(size + count);
        came_ += count;
        if (count == 0) {
            break;
        }
    }
    expect_modest();
    content.shrink_to_fit();
    return content;
}

} // namespace macadam
