#include "storage/store/server/user_files.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Folder from a variable, which must be absolute as its specification demands, or below HOME.
///
/// Source: XDG Base Directory Specification 0.8.
std::optional<fs::path> user_folder(const char* variable, const char* below_home) {
    const auto absolute = [](const char* name) -> std::optional<fs::path> {
        const char* const value = std::getenv(name); // NOLINT(concurrency-mt-unsafe)
        const fs::path path{value == nullptr ? "" : value};
        return path.is_absolute() ? std::optional{path} : std::nullopt;
    };
    if (auto folder = absolute(variable)) {
        return folder;
    }
    const auto home = absolute("HOME");
    return home ? std::optional{*home / below_home} : std::nullopt;
}

/// Refuses a name with which a server could lead elsewhere.
void expect_plain(const std::string& name, std::string_view what) {
    constexpr std::size_t longest = 64;
    if (name.empty() || name.size() > longest ||
        name.find_first_not_of("0123456789abcdef-") != std::string::npos) {
        throw InputError{fmt::format("the server's {} is {}, expected hex digits; the database was "
                                     "modified by another program",
                                     what,
                                     in_quotes(name))};
    }
}

fs::path cache_folder(std::string_view use) {
    const auto folder = user_folder("XDG_CACHE_HOME", ".cache");
    if (!folder) { // others could put a file into a shared folder first
        throw InputError{fmt::format("neither HOME nor XDG_CACHE_HOME is set, expected the folder "
                                     "in which macadam/{}",
                                     use)};
    }
    return *folder / "macadam";
}

} // namespace

fs::path server_key_file(const std::string& key_id) {
    expect_plain(key_id, "key_id");
    const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
    if (!folder) {
        throw InputError{"neither HOME nor XDG_CONFIG_HOME is set, expected the folder that has "
                         "macadam/keys/ with the keys of databases on servers"};
    }
    return *folder / "macadam" / "keys" / (key_id + ".key");
}

fs::path network_image_file(const std::string& address, const std::string& rows) {
    expect_plain(rows, "network_rows");
    Sha256 hash;
    hash.add(address);
    return cache_folder("networks/ keeps the roads of databases on servers") / "networks" /
           fmt::format("{}-{}-{}.gpkg", hash.hex(), rows, store_version);
}

fs::path mirror_folder() {
    return cache_folder("copies/ keeps copies of databases on servers") / "copies";
}

} // namespace macadam
