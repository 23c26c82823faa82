#pragma once

#include "mapping/style/map_style_values.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Appearance that the provider of a database suggests in a `macadam.toml` beside it. The file may
/// be somebody else's: it can change how maps look, and nothing else.
struct DatabaseAppearance {
    std::optional<std::string> unit;     ///< "mm/m" or "in/mi"
    std::optional<std::string> language; ///< "en" or "de"
    std::optional<std::string> theme;    ///< "light", "dark" or "print"
    ThemeColours colours;
};

inline constexpr std::size_t max_appearance_bytes = 16'384;

/// Returns "roads/macadam.toml" for "roads/town.gpkg".
std::filesystem::path appearance_file_of(const std::filesystem::path& store);

/// Reads the file beside a database; `std::nullopt` if there is none.
///
/// \throws InputError  if it is no regular file (links are not followed), larger than
///                     max_appearance_bytes, no TOML, or has other keys or invalid values.
std::optional<DatabaseAppearance> read_appearance(const std::filesystem::path& file);

/// Parses the text of such a file; `name` stands for it in messages.
/// \throws InputError
DatabaseAppearance parse_appearance(std::string_view text, const std::string& name);

} // namespace macadam
