#include "storage/uploads/sealed_log.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using Bytes = std::array<unsigned char, LogKey::size>;

static_assert(LogKey::size == crypto_box_SECRETKEYBYTES &&
              LogKey::size == crypto_box_PUBLICKEYBYTES &&
              LogKey::size == crypto_secretstream_xchacha20poly1305_KEYBYTES);

constexpr std::string_view first_line = "macadam sealed log 1\n";
constexpr std::string_view mark_of_key = "# Secret key of the logs ";
constexpr std::string_view first_line_of_key =
    "# Secret key of the logs that a Macadam server keeps: with it they can be read. Keep it away "
    "from the server.\n";
constexpr std::size_t box_bytes = crypto_box_SEALBYTES + LogKey::size;
constexpr std::size_t header_bytes = crypto_secretstream_xchacha20poly1305_HEADERBYTES;
constexpr std::size_t seal_bytes = crypto_secretstream_xchacha20poly1305_ABYTES;
constexpr std::size_t block_bytes = std::size_t{64} * 1024;
constexpr unsigned owner_alone = 0600;

void start_sodium() {
    if (sodium_init() < 0) {
        throw InputError{"this system provides no random numbers"};
    }
}

/// Secret bytes that are overwritten at the end.
template <typename Value>
struct Wiped {
    Value value{};
    Wiped() = default;
    Wiped(const Wiped&) = delete;
    Wiped& operator=(const Wiped&) = delete;
    ~Wiped() { sodium_memzero(&value, sizeof value); }
};

std::string_view text_in(std::span<const unsigned char> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string hex_of(const Bytes& bytes) {
    std::array<char, 2 * LogKey::size + 1> text{};
    sodium_bin2hex(text.data(), text.size(), bytes.data(), bytes.size());
    return text.data();
}

std::optional<Bytes> bytes_in(std::string_view digits) {
    Bytes bytes{};
    std::size_t count = 0;
    const char* end = nullptr;
    const bool is_hex =
        sodium_hex2bin(
            bytes.data(), bytes.size(), digits.data(), digits.size(), nullptr, &count, &end) == 0;
    return is_hex && count == bytes.size() && end == digits.data() + digits.size()
               ? std::optional{bytes}
               : std::nullopt;
}

std::string_view second_line(std::string_view text) {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    return trimmed(text.substr(0, text.find_first_of("\r\n")));
}

/// Fills a span as far as the stream goes. \returns the filled part.
std::span<unsigned char> filled(ByteStream& from, std::span<unsigned char> into) {
    std::size_t done = 0;
    while (done < into.size()) {
        const auto count =
            from.read({reinterpret_cast<char*>(into.data()) + done, into.size() - done});
        if (count == 0) {
            break;
        }
        done += count;
    }
    return into.first(done);
}

/// Stream of a secret key of its own, by libsodium.
using Stream = Wiped<crypto_secretstream_xchacha20poly1305_state>;

/// File in memory, which this process alone can read, under a link on disk.
class MemoryFile {
public:
    explicit MemoryFile(fs::path link)
        : link_{std::move(link)}, descriptor_{::memfd_create("macadam log", MFD_CLOEXEC)} {
        if (descriptor_ < 0) {
            fail(errno);
        }
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() {
        std::error_code gone;
        fs::remove(link_, gone);
        ::close(descriptor_);
    }

    void write(std::string_view bytes) {
        while (!bytes.empty()) {
            const auto count = ::write(descriptor_, bytes.data(), bytes.size());
            if (count < 0 && errno != EINTR) {
                fail(errno);
            }
            bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(0, count)));
        }
    }

    void show() {
        std::error_code error;
        fs::create_symlink(fmt::format("/proc/self/fd/{}", descriptor_), link_, error);
        if (error) {
            fail(error.value());
        }
    }

    const fs::path& link() const { return link_; }

private:
    [[noreturn]] void fail(int error) const {
        throw InputError{
            fmt::format("{}: cannot be opened: {}", link_.string(), std::strerror(error))};
    }

    fs::path link_;
    int descriptor_;
};

[[noreturn]] void refuse(const fs::path& sealed, std::string_view why) {
    throw InputError{fmt::format("{}: {}", sealed.string(), why)};
}

void open_box(const fs::path& sealed,
              std::span<const unsigned char> box,
              const LogKey& key,
              Bytes& key_of_log) {
    const auto own = key.public_bytes();
    if (crypto_box_seal_open(
            key_of_log.data(), box.data(), box.size(), own.data(), key.secret().data()) != 0) {
        refuse(sealed,
               "was not sealed for this key, or was changed; expected the key that "
               "'macadam init --logs-key' wrote");
    }
}

} // namespace

// ---------------------------------------------------------------------------------------- keys

LogKey LogKey::make() {
    start_sodium();
    Wiped<Bytes> secret;
    Bytes ignored{};
    crypto_box_keypair(ignored.data(), secret.value.data());
    return LogKey{secret.value};
}

LogKey::~LogKey() {
    sodium_memzero(secret_.data(), secret_.size());
}

std::array<unsigned char, LogKey::size> LogKey::public_bytes() const {
    Bytes bytes{};
    crypto_scalarmult_base(bytes.data(), secret_.data());
    return bytes;
}

std::string LogKey::public_key() const {
    return hex_of(public_bytes());
}

void write_log_key(const fs::path& file, const LogKey& key) {
    AtomicFile whole{file, owner_alone};
    whole.write(fmt::format("{}{}\n", first_line_of_key, hex_of(key.secret())));
    whole.commit_new();
}

LogKey read_log_key(const fs::path& file) {
    start_sodium();
    constexpr std::size_t longest = 1024;
    std::array<unsigned char, longest> bytes{};
    const auto text = text_in(filled(*file_bytes(file), bytes));
    const auto secret = text.starts_with(mark_of_key) ? bytes_in(second_line(text)) : std::nullopt;
    if (!secret) {
        refuse(file,
               "is not a key of logs, expected the file that 'macadam init --logs-key' wrote");
    }
    return LogKey{*secret};
}

// ------------------------------------------------------------------------------ seal and open

void seal_log(const fs::path& log, const fs::path& sealed, std::string_view public_key) {
    start_sodium();
    const auto to = bytes_in(public_key);
    if (!to) {
        refuse(sealed, fmt::format("'{}' is no public key of logs", public_key));
    }
    Wiped<Bytes> key;
    crypto_secretstream_xchacha20poly1305_keygen(key.value.data());
    std::array<unsigned char, box_bytes> box{};
    std::array<unsigned char, header_bytes> header{};
    Stream stream;
    if (crypto_box_seal(box.data(), key.value.data(), key.value.size(), to->data()) != 0 ||
        crypto_secretstream_xchacha20poly1305_init_push(
            &stream.value, header.data(), key.value.data()) != 0) {
        refuse(sealed, fmt::format("'{}' is no public key of logs", public_key));
    }
    AtomicFile file{sealed, owner_alone};
    file.write(first_line);
    file.write(text_in(box));
    file.write(text_in(header));
    const auto from = file_bytes(log);
    std::vector<unsigned char> plain(block_bytes);
    std::vector<unsigned char> block(block_bytes + seal_bytes);
    for (bool ends = false; !ends;) {
        const auto part = filled(*from, plain);
        ends = part.size() < plain.size();
        crypto_secretstream_xchacha20poly1305_push(
            &stream.value,
            block.data(),
            nullptr,
            part.data(),
            part.size(),
            nullptr,
            0,
            ends ? crypto_secretstream_xchacha20poly1305_TAG_FINAL : 0);
        file.write(text_in(std::span{block}.first(part.size() + seal_bytes)));
    }
    sodium_memzero(plain.data(), plain.size());
    file.commit();
}

std::shared_ptr<const fs::path>
opened_log(const fs::path& sealed, const LogKey& key, const fs::path& link) {
    start_sodium();
    const auto from = file_bytes(sealed);
    std::array<unsigned char, first_line.size() + box_bytes + header_bytes> head{};
    if (filled(*from, head).size() != head.size() || !text_in(head).starts_with(first_line)) {
        refuse(sealed, "is no sealed log");
    }
    Wiped<Bytes> key_of_log;
    Stream stream;
    open_box(sealed, std::span{head}.subspan(first_line.size(), box_bytes), key, key_of_log.value);
    const auto* const header = head.data() + first_line.size() + box_bytes;
    auto file = std::make_shared<MemoryFile>(link);
    std::vector<unsigned char> block(block_bytes + seal_bytes);
    std::vector<unsigned char> plain(block_bytes);
    bool is_sound = crypto_secretstream_xchacha20poly1305_init_pull(
                        &stream.value, header, key_of_log.value.data()) == 0;
    for (bool ends = false; is_sound && !ends;) {
        const auto part = filled(*from, block);
        unsigned char tag = 0;
        is_sound =
            part.size() >= seal_bytes &&
            crypto_secretstream_xchacha20poly1305_pull(
                &stream.value, plain.data(), nullptr, &tag, part.data(), part.size(), nullptr, 0) ==
                0;
        if (is_sound) {
            file->write(text_in(std::span{plain}.first(part.size() - seal_bytes)));
            ends = tag == crypto_secretstream_xchacha20poly1305_TAG_FINAL;
        }
    }
    sodium_memzero(plain.data(), plain.size());
    std::array<unsigned char, 1> more{};
    if (!is_sound || !filled(*from, more).empty()) {
        refuse(sealed, "was changed or cut off");
    }
    file->show();
    return {file, &file->link()};
}

} // namespace macadam
