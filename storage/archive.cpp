#include "storage/byte_stream.hpp"

#include "estimator/common/error.hpp"
#include "storage/text.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <string_view>

namespace macadam {

namespace {

constexpr std::size_t input_block = 64 << 10;

struct Free {
    void operator()(archive* reader) const { archive_read_free(reader); }
};
using Reader = std::unique_ptr<archive, Free>;

[[noreturn]] void fail(archive* reader, const std::string& name) {
    const char* const cause = archive_error_string(reader);
    throw InputError{fmt::format("{}: the archive is cut off or damaged: {}",
                                 name,
                                 cause != nullptr ? cause : "its structure is broken")};
}

Reader open(const std::filesystem::path& file) {
    Reader reader{archive_read_new()};
    archive_read_support_format_zip(reader.get());
    archive_read_support_format_tar(reader.get());
    archive_read_support_filter_gzip(reader.get());
    archive_read_support_filter_zstd(reader.get());
    if (archive_read_open_filename(reader.get(), file.c_str(), input_block) != ARCHIVE_OK) {
        if (std::ifstream{file}) { // it is there, but no archive
            fail(reader.get(), file.string());
        }
        const char* const cause = archive_error_string(reader.get());
        throw InputError{fmt::format("{}: cannot be read{}{}",
                                     file.string(),
                                     cause != nullptr ? ": " : "",
                                     cause != nullptr ? cause : "")};
    }
    return reader;
}

/// The next regular file; null at the end.
archive_entry* next_file(archive* reader, const std::string& name) {
    for (;;) {
        archive_entry* entry = nullptr;
        const auto result = archive_read_next_header(reader, &entry);
        if (result == ARCHIVE_EOF) {
            return nullptr;
        }
        if (result != ARCHIVE_OK && result != ARCHIVE_WARN) {
            fail(reader, name);
        }
        if (archive_entry_filetype(entry) == AE_IFREG) {
            return entry;
        }
    }
}

std::string name_of(archive_entry* entry) {
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr) { // not to be spelled in this locale
        name = archive_entry_pathname_utf8(entry);
    }
    return name != nullptr ? name : "";
}

class MemberBytes final : public ByteStream {
public:
    MemberBytes(const std::filesystem::path& file, const std::string& member)
        : name_{fmt::format("{}/{}", file.string(), member)}, reader_{open(file)} {
        for (;;) {
            auto* const entry = next_file(reader_.get(), file.string());
            if (entry == nullptr) {
                throw InputError{
                    fmt::format("{}: has no file {}", file.string(), in_quotes(member, 200))};
            }
            if (name_of(entry) == member) {
                break;
            }
        }
        before_ = position();
    }

    std::size_t read(std::span<char> into) override {
        const auto count = archive_read_data(reader_.get(), into.data(), into.size());
        if (count < 0) {
            fail(reader_.get(), name_);
        }
        return static_cast<std::size_t>(count);
    }

    // The block that holds the member's header was read before it.
    std::uint64_t consumed() const override {
        const auto now = position();
        return (now > before_ ? now - before_ : 0) + std::min<std::uint64_t>(before_, input_block);
    }

private:
    std::uint64_t position() const {
        return static_cast<std::uint64_t>(archive_filter_bytes(reader_.get(), -1));
    }

    std::string name_;
    Reader reader_;
    std::uint64_t before_ = 0;
};

} // namespace

std::unique_ptr<ByteStream> member_bytes(const std::filesystem::path& archive,
                                         const std::string& member) {
    return std::make_unique<MemberBytes>(archive, member);
}

std::vector<std::string> members_of(const std::filesystem::path& archive) {
    const auto reader = open(archive);
    std::vector<std::string> names;
    while (auto* const entry = next_file(reader.get(), archive.string())) {
        names.push_back(name_of(entry));
    }
    return names;
}

} // namespace macadam
