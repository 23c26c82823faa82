#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "render/scene/scene.hpp"

#include <optional>
#include <string_view>

namespace macadam {

inline constexpr Option style_option{"--style",
                                     "FILE",
                                     "TOML file with classes, colours, widths and texts "
                                     "(docs/reference/pictures.md)."};

inline constexpr Option grey_below_option{
    "--min-passes", "N", "Draw roads with fewer passes of cars in grey.", "1"};

/// Of --style, or as the program has it. What other options say comes on top.
///
/// \throws InputError  for a file that is no style.
MapStyle parse_style_file(const Arguments& arguments);

/// Of --min-passes. \throws UsageError  for less than 1.
std::optional<int> grey_below(const Arguments& arguments);

/// The table of that name. \throws UsageError  naming --classes, if there is none.
const ClassTable* class_table_option(std::string_view name);

/// Says so where readers could take the look of a map for something else.
void warn_of_look(const MapStyle& style, const Console& console);

} // namespace macadam
