#pragma once

#include "mapping/style/map_style_values.hpp"
#include "storage/tables/toml.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

inline constexpr std::size_t max_own_classes = 12; ///< more colours are hard to distinguish

/// Reads the style of a map from a TOML file: classes, colours, widths and legend texts.
/// docs/reference/pictures.md lists the keys.
///
/// \throws InputError  "file:line: ..." for an unknown key, an invalid colour, class limits that do
///                     not rise, more than max_own_classes, or texts without their {}.
MapLook read_style(const std::filesystem::path& file);

/// \name Parts of a style that other files may have
/// @{
inline constexpr std::array<std::string_view, 3> theme_words{"light", "dark", "print"};
inline constexpr std::array<std::string_view, 2> iri_unit_words{"mm/m", "in/mi"};

/// \throws InputError  if the text of a key is none of the words.
std::string
word_among(const TomlTable& table, std::string_view key, std::span<const std::string_view> words);

/// Reads [colours].
/// \throws InputError
ThemeColours read_colours(const TomlTable& table);
/// @}

} // namespace macadam
