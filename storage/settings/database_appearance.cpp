#include "storage/settings/database_appearance.hpp"

#include "estimator/common/error.hpp"
#include "storage/settings/style_file.hpp"
#include "storage/tables/toml.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> keys{"unit", "language", "theme", "colours"};
constexpr std::array<std::string_view, 6> ground_colours{
    "page", "ground", "border", "ink", "quiet_ink", "casing"};

/// Returns true for letters, digits and hyphens, which lead to no file of another folder.
bool is_language_code(std::string_view code) {
    constexpr std::size_t max_letters = 35; // BCP 47
    return !code.empty() && code.size() <= max_letters && std::ranges::all_of(code, [](char c) {
        return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') ||
               c == '-';
    });
}

/// Descriptor of an open file.
class OpenFile {
public:
    explicit OpenFile(int descriptor) : descriptor_{descriptor} {}
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
    int descriptor() const { return descriptor_; }

private:
    int descriptor_;
};

[[noreturn]] void refuse(const fs::path& file, std::string_view why) {
    throw InputError{fmt::format("{}: {}", file.string(), why)};
}

/// Reads at most `max_bytes`; the size that fstat() tells may have changed since.
std::string bytes_of(const OpenFile& open, std::size_t max_bytes, const fs::path& file) {
    std::string text(max_bytes, '\0');
    std::size_t size = 0;
    while (size < max_bytes) {
        const auto more = ::read(open.descriptor(), text.data() + size, max_bytes - size);
        if (more < 0 && errno == EINTR) {
            continue;
        }
        if (more < 0) {
            refuse(file, std::strerror(errno));
        }
        if (more == 0) {
            break;
        }
        size += static_cast<std::size_t>(more);
    }
    text.resize(size);
    return text;
}

} // namespace

fs::path appearance_file_of(const fs::path& store) {
    return store.parent_path() / "macadam.toml";
}

std::optional<DatabaseAppearance> read_appearance(const fs::path& file) {
    // Without O_NONBLOCK, opening a pipe would wait for its writer.
    const OpenFile open{::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)};
    if (open.descriptor() < 0 && (errno == ENOENT || errno == ENOTDIR)) {
        return {};
    }
    if (open.descriptor() < 0) {
        refuse(file, errno == ELOOP ? "is a link, which is not followed" : std::strerror(errno));
    }
    struct stat status {};
    if (::fstat(open.descriptor(), &status) != 0 || !S_ISREG(status.st_mode)) {
        refuse(file, "is no regular file");
    }
    const auto text = bytes_of(open, max_appearance_bytes + 1, file);
    if (text.size() > max_appearance_bytes) {
        refuse(file, fmt::format("is longer than {} bytes", max_appearance_bytes));
    }
    return parse_appearance(text, file.string());
}

DatabaseAppearance parse_appearance(std::string_view text, const std::string& name) {
    const auto top = parse_toml(text, name);
    top.expect_only(keys);
    DatabaseAppearance appearance;
    if (top.has("unit")) {
        appearance.unit = word_among(top, "unit", iri_unit_words);
    }
    if (top.has("language")) {
        appearance.language = top.text("language");
        if (!is_language_code(*appearance.language)) {
            top.refuse("language", "a code such as \"de\"");
        }
    }
    if (top.has("theme")) {
        appearance.theme = word_among(top, "theme", theme_words);
    }
    if (const auto colours = top.table("colours")) {
        colours->expect_only(ground_colours); // none in which roads without a value are drawn
        appearance.colours = read_colours(*colours);
    }
    return appearance;
}

} // namespace macadam
