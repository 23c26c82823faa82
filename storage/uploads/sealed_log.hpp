#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Secret key that opens sealed logs. Whoever seals needs its public key only.
class LogKey {
public:
    static constexpr std::size_t size = 32;

    /// Creates a key from the system's random numbers.
    static LogKey make();

    explicit LogKey(const std::array<unsigned char, size>& secret) : secret_{secret} {}
    LogKey(const LogKey&) = default;
    LogKey& operator=(const LogKey&) = default;
    ~LogKey(); ///< overwrites the secret

    const std::array<unsigned char, size>& secret() const { return secret_; }
    std::array<unsigned char, size> public_bytes() const;

    /// Public key as 64 hex digits.
    std::string public_key() const;

private:
    std::array<unsigned char, size> secret_;
};

/// Writes a key to a new file, readable only by its owner, and syncs it.
/// \throws InputError  if the file exists or cannot be written.
void write_log_key(const std::filesystem::path& file, const LogKey& key);

/// \throws InputError  if there is no such file, or it does not hold a key.
LogKey read_log_key(const std::filesystem::path& file);

/// Writes the encrypted copy of a log, readable only by its owner, and syncs it. Only the holder of
/// the secret key can read it, or learn more of it than its size; whoever changes or shortens it is
/// found out.
///
/// The copy is the line "macadam sealed log 1", a key of its own in a sealed box, and the log in
/// blocks of 64 KiB as a stream of XChaCha20-Poly1305.
///
/// Source: https://doc.libsodium.org/public-key_cryptography/sealed_boxes and
/// https://doc.libsodium.org/secret-key_cryptography/secretstream
///
/// \param public_key  64 hex digits
/// \throws InputError  if a file cannot be read or written, or `public_key` is none.
void seal_log(const std::filesystem::path& log,
              const std::filesystem::path& sealed,
              std::string_view public_key);

/// Opens a sealed log in memory.
/// \param link  file name under which this process can read the log while the result lasts: a link
///              without content, so that no readable byte is on a disk
/// \returns the link, which owns the log and vanishes with it.
/// \throws InputError  if it is no sealed log, was changed or shortened, or was sealed for another
///                     key.
std::shared_ptr<const std::filesystem::path> opened_log(const std::filesystem::path& sealed,
                                                        const LogKey& key,
                                                        const std::filesystem::path& link);

} // namespace macadam
