#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Secret under which a database names its cars and draws its random numbers. It lies in a file of
/// its own, so that who has the database alone cannot tell whether a car is in it.
///
/// Everything is HMAC-SHA-256 (RFC 2104) over a text that begins with what it is for.
class PrivacyKey {
public:
    using Bytes = std::array<unsigned char, 32>;

    /// A new one, from the system's random numbers.
    static PrivacyKey make();

    explicit PrivacyKey(const Bytes& bytes) : bytes_{bytes} {}

    /// 32 hex digits by which a database knows its key, and which tell nothing of it.
    std::string id() const;

    /// Name of a car in the database: "v-" and 32 hex digits; "unknown" for "".
    std::string pseudonym(std::string_view vehicle_id) const;

    /// The same, from the name that databases of version 2 gave the car.
    std::string pseudonym_of_unkeyed(std::string_view name) const;

    /// Numbers in [0, 1) that are the same each time for the same trip and purpose, and that nobody
    /// can foretell without the key.
    std::vector<double>
    draw(std::string_view trip_sha256, std::string_view purpose, std::size_t count) const;

    /// 64 hex digits, as the file holds them.
    std::string hex() const;

private:
    Bytes hmac(std::string_view text) const;

    Bytes bytes_;
};

/// Name of all trips that name no car.
inline constexpr std::string_view unknown_car = "unknown";

/// Name of a car in databases of version 2: "v-" and the first 12 hex digits of the SHA-256 of its
/// id. Pseudonyms are made of it, so that a database that was upgraded knows its cars again.
std::string unkeyed_name_of(std::string_view vehicle_id);

/// Whether it is that name, in less time.
bool is_unkeyed_name_of(std::string_view name, std::string_view vehicle_id);

/// Where the key of a database lies: "roads.gpkg.key" beside roads.gpkg, wherever links lead.
std::filesystem::path key_file_of(const std::filesystem::path& database);

/// Nothing if there is no such file, or if this user may not read it.
/// \throws InputError  if it holds no key.
std::optional<PrivacyKey> read_key(const std::filesystem::path& file);

/// Writes a file that did not exist, for its owner alone, to the disk.
/// \throws InputError  if it exists or cannot be written; then nothing of ours is left.
void write_key(const std::filesystem::path& file, const PrivacyKey& key);

/// Whether others than its owner may read or write it.
bool is_open_to_others(const std::filesystem::path& key_file);

} // namespace macadam
