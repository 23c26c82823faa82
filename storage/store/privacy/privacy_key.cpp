#include "storage/store/privacy/privacy_key.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/sha.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <system_error>

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line =
    "# Key of a Macadam database: with it, and a car's id, the car's trips are found in it. Keep "
    "it secret, and a copy of it apart from the database.\n";
constexpr std::size_t name_digits = 32; // 128 bits
constexpr std::size_t unkeyed_digits = 12;

std::string hex_of(std::span<const unsigned char> bytes) {
    std::string text;
    for (const auto byte : bytes) {
        text += fmt::format("{:02x}", byte);
    }
    return text;
}

PrivacyKey::Bytes sha256_of(std::string_view text) {
    PrivacyKey::Bytes result{};
    SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), result.data());
    return result;
}

std::optional<PrivacyKey> key_in(std::string_view digits) {
    PrivacyKey::Bytes bytes{};
    if (digits.size() != 2 * bytes.size()) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const char* const at = digits.data() + 2 * i;
        const auto [end, error] = std::from_chars(at, at + 2, bytes[i], 16);
        if (error != std::errc{} || end != at + 2) {
            return std::nullopt;
        }
    }
    return PrivacyKey{bytes};
}

std::string_view line_in(std::string_view text) {
    return trimmed(text.substr(0, text.find_first_of("\r\n")));
}

[[noreturn]] void fail(const fs::path& file, std::string_view what, int error) {
    throw InputError{fmt::format("{}: {}: {}", file.string(), what, std::strerror(error))};
}

} // namespace

PrivacyKey PrivacyKey::make() {
    Bytes bytes{};
    // Up to 256 bytes are returned in full (getrandom(2)).
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        throw InputError{fmt::format("no random numbers for a key: {}", std::strerror(errno))};
    }
    return PrivacyKey{bytes};
}

PrivacyKey::Bytes PrivacyKey::hmac(std::string_view text) const {
    Bytes result{};
    unsigned int size = 0;
    if (HMAC(EVP_sha256(),
             bytes_.data(),
             static_cast<int>(bytes_.size()),
             reinterpret_cast<const unsigned char*>(text.data()),
             text.size(),
             result.data(),
             &size) == nullptr ||
        size != result.size()) {
        throw std::bad_alloc{}; // the only possible cause
    }
    return result;
}

std::string PrivacyKey::id() const {
    return hex_of(hmac("macadam key 1")).substr(0, name_digits);
}

std::string PrivacyKey::pseudonym(std::string_view vehicle_id) const {
    return pseudonym_of_unkeyed(unkeyed_name_of(vehicle_id));
}

std::string PrivacyKey::pseudonym_of_unkeyed(std::string_view name) const {
    if (name == unknown_car) {
        return std::string{unknown_car};
    }
    return "v-" + hex_of(hmac(fmt::format("macadam car 1\n{}", name))).substr(0, name_digits);
}

std::vector<double>
PrivacyKey::draw(std::string_view trip_sha256, std::string_view purpose, std::size_t count) const {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) {
        const auto bytes = hmac(fmt::format("macadam draw 1\n{}\n{}\n{}", purpose, trip_sha256, i));
        std::uint64_t bits = 0;
        for (const auto byte : std::span{bytes}.first(8)) {
            bits = bits << 8U | byte;
        }
        numbers.push_back(static_cast<double>(bits >> 11U) * 0x1p-53);
    }
    return numbers;
}

std::string PrivacyKey::hex() const {
    return hex_of(bytes_);
}

std::string unkeyed_name_of(std::string_view vehicle_id) {
    if (vehicle_id.empty()) {
        return std::string{unknown_car};
    }
    return "v-" + hex_of(sha256_of(vehicle_id)).substr(0, unkeyed_digits);
}

bool is_unkeyed_name_of(std::string_view name, std::string_view vehicle_id) {
    unsigned char first = 0; // excludes most texts without formatting them
    const char* const digits = name.data() + 2;
    if (name.size() != 2 + unkeyed_digits ||
        std::from_chars(digits, digits + 2, first, 16).ptr != digits + 2) {
        return false;
    }
    return sha256_of(vehicle_id)[0] == first && unkeyed_name_of(vehicle_id) == name;
}

fs::path key_file_of(const fs::path& database) {
    std::error_code ignored;
    auto file = fs::weakly_canonical(database, ignored);
    if (file.empty()) {
        file = database;
    }
    file += ".key";
    return file;
}

std::optional<PrivacyKey> read_key(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) {
        if (errno == ENOENT || errno == EACCES) {
            return std::nullopt;
        }
        fail(file, "cannot be read", errno);
    }
    std::string text(first_line.size() + 2 * sizeof(PrivacyKey::Bytes) + 16, '\0');
    const auto size = ::read(descriptor, text.data(), text.size());
    const int error = errno;
    ::close(descriptor);
    if (size < 0) {
        fail(file, "cannot be read", error);
    }
    text.resize(static_cast<std::size_t>(size));
    const auto line = text.find('\n');
    const auto key = text.starts_with("# ") && line != std::string::npos
                         ? key_in(line_in(std::string_view{text}.substr(line + 1)))
                         : std::nullopt;
    if (!key) {
        throw InputError{fmt::format("{}: is not a key file, expected a line that begins with "
                                     "'#' and a line of {} hex digits; restore the database's "
                                     "key from a copy",
                                     file.string(),
                                     2 * sizeof(PrivacyKey::Bytes))};
    }
    return key;
}

void write_key(const fs::path& file, const PrivacyKey& key) {
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(file, ignored))) {
        fail(file, "exists, but this user may not read it", EEXIST);
    }
    AtomicFile whole{file, 0600};
    whole.write(fmt::format("{}{}\n", first_line, key.hex()));
    whole.commit_new();
}

bool is_open_to_others(const fs::path& key_file) {
    std::error_code error;
    const auto permissions = fs::status(key_file, error).permissions();
    using enum fs::perms;
    return !error && (permissions & (group_all | others_all)) != none;
}

} // namespace macadam
