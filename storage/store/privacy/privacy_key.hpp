#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Secret key under which a database names its cars and draws its random numbers. It is stored in a
/// separate file, so that the database alone does not reveal whether it contains a car.
///
/// All functions are HMAC-SHA-256 (RFC 2104) of a text that begins with its purpose.
class PrivacyKey {
public:
    using Bytes = std::array<unsigned char, 32>;

    /// Creates a key from the system's random numbers.
    static PrivacyKey make();

    explicit PrivacyKey(const Bytes& bytes) : bytes_{bytes} {}

    /// 32 hex digits that identify the key without revealing it.
    std::string id() const;

    /// Name of a car in the database: "v-" and 32 hex digits; "unknown" for "".
    std::string pseudonym(std::string_view vehicle_id) const;

    /// Pseudonym of a car, derived from its name in databases of version 2.
    std::string pseudonym_of_unkeyed(std::string_view name) const;

    /// Random numbers in [0, 1), reproducible for a trip and purpose, and unpredictable without the
    /// key.
    std::vector<double>
    draw(std::string_view trip_sha256, std::string_view purpose, std::size_t count) const;

    /// Key as 64 hex digits, as stored in the file.
    std::string hex() const;

private:
    Bytes hmac(std::string_view text) const;

    Bytes bytes_;
};

/// Name of the car of all trips without a vehicle id.
inline constexpr std::string_view unknown_car = "unknown";

/// Name of a car in databases of version 2: "v-" and the first 12 hex digits of the SHA-256 of its
/// id. Pseudonyms are derived from it, so that an upgraded database recognises its cars.
std::string unkeyed_name_of(std::string_view vehicle_id);

/// Tests whether `name` is that name, faster than by comparison.
bool is_unkeyed_name_of(std::string_view name, std::string_view vehicle_id);

/// Key file of a database, beside the target of any links: "roads.gpkg.key" for roads.gpkg.
std::filesystem::path key_file_of(const std::filesystem::path& database);

/// Reads a key; `std::nullopt` if the file does not exist or this user may not read it.
/// \throws InputError  if the file does not hold a key.
std::optional<PrivacyKey> read_key(const std::filesystem::path& file);

/// Writes a key to a new file, readable only by its owner, and syncs it.
/// \throws InputError  if the file exists or cannot be written; then no partial file remains.
void write_key(const std::filesystem::path& file, const PrivacyKey& key);

/// Tests whether users other than the owner may read or write the file.
bool is_open_to_others(const std::filesystem::path& key_file);

} // namespace macadam
