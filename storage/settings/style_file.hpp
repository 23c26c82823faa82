#pragma once

#include "mapping/style/map_style_values.hpp"

#include <filesystem>

namespace macadam {

inline constexpr std::size_t max_own_classes = 12; ///< more colours nobody tells apart

/// Reads how a map is to look: a TOML file with classes, colours, widths and words of the legend.
/// docs/reference/pictures.md lists the keys.
///
/// \throws InputError  "file:line: ..." for a key that is not known, a colour that is none, borders
///                     that do not rise, more than max_own_classes, or words without their {}.
MapLook read_style(const std::filesystem::path& file);

} // namespace macadam
