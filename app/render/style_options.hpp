#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "mapping/style/map_style_values.hpp"
#include "render/scene/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

inline constexpr Option style_option =
    preference(in_group("appearance",
                        {"--style",
                         "FILE",
                         "TOML file with classes, colours, widths and texts "
                         "(docs/reference/pictures.md)."}));

inline constexpr Option grey_below_option = in_group(
    "appearance", {"--grey-below", "N", "Draw roads with fewer passes of cars in grey.", "1"});

/// Look that the user wants, and what the provider of the database suggests.
struct ChosenLook {
    MapLook look;
    std::optional<std::string> language; ///< of reports
};

/// Reads the style of --style and the options --theme, --units, --classes, --ramp and --language of
/// a command that has them. In order of rank: options on the command line, the style file, defaults
/// of these options, and for unit, language, theme and colours the file macadam.toml beside the
/// database. A macadam.toml that is no such file is ignored with a warning.
///
/// \throws InputError  for a --style that is no style.
ChosenLook
parse_look(const Arguments& arguments, const std::filesystem::path& store, const Console& console);

/// Builds the style of a map. Its classes are null if the look states none.
MapStyle style_of(MapLook look);

/// Parses --grey-below.
/// \throws UsageError  for less than 1.
std::optional<int> grey_below(const Arguments& arguments);

/// Parses the style of a picture of STORE: parse_look, --left-hand, --no-labels and --grey-below.
MapStyle parse_style(const Arguments& arguments, const Console& console);

/// Warns if readers could misinterpret the look of a map.
void warn_of_look(const MapStyle& style, const Console& console);

} // namespace macadam
