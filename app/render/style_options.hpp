#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "render/scene/scene.hpp"

#include <optional>
#include <string_view>

namespace macadam {

inline constexpr Option style_option =
    in_group("appearance",
             {"--style",
              "FILE",
              "TOML file with classes, colours, widths and texts "
              "(docs/reference/pictures.md)."});

inline constexpr Option grey_below_option = in_group(
    "appearance", {"--grey-below", "N", "Draw roads with fewer passes of cars in grey.", "1"});

/// Reads the style of --style, or returns the default one. Other options override it.
///
/// \throws InputError  for a file that is no style.
MapStyle parse_style_file(const Arguments& arguments);

/// Parses --grey-below.
/// \throws UsageError  for less than 1.
std::optional<int> grey_below(const Arguments& arguments);

/// Warns if readers could misinterpret the look of a map.
void warn_of_look(const MapStyle& style, const Console& console);

} // namespace macadam
