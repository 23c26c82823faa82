#pragma once

#include "mapping/style/map_style_values.hpp"

#include <filesystem>

namespace macadam {

inline constexpr std::size_t max_own_classes = 12; ///< more colours are hard to distinguish

/// Reads the style of a map from a TOML file: classes, colours, widths and legend texts.
/// docs/reference/pictures.md lists the keys.
///
/// \throws InputError  "file:line: ..." for an unknown key, an invalid colour, class limits that do
///                     not rise, more than max_own_classes, or texts without their {}.
MapLook read_style(const std::filesystem::path& file);

} // namespace macadam
