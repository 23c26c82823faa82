#pragma once

#include "mapping/style/custom_class_table.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Colours other than those of classes, 0xRRGGBB; `std::nullopt`: from the theme.
struct ThemeColours {
    std::optional<std::uint32_t> page;       ///< under title, scale bar and legend
    std::optional<std::uint32_t> ground;     ///< under the roads
    std::optional<std::uint32_t> border;     ///< hairlines
    std::optional<std::uint32_t> ink;        ///< primary text
    std::optional<std::uint32_t> quiet_ink;  ///< secondary text
    std::optional<std::uint32_t> casing;     ///< along every measured road
    std::optional<std::uint32_t> unmeasured; ///< roads without a pass
    std::optional<std::uint32_t> few_passes; ///< roads with too few passes
};

/// Factors relative to the default widths at the map's scale.
struct LineFactors {
    double width = 1;
    double casing = 1;
};

/// Texts of the legend. In `few_passes` {} stands for the number of passes, in texts of values for
/// the value.
struct LegendWords {
    std::optional<std::string> title; ///< `std::nullopt`: "Roughness, IRI in" and the unit
    std::string few_passes = "Fewer than {} passes";
    std::string uncertain = "Uncertain";
    std::string unmeasured = "No measurement";
    std::string below = "below {}";
    std::string up_to = "up to {}";
    std::string from = "from {}";
    std::string above = "above {}";
    std::string all = "all";
    std::string note; ///< below the entries: how to read the map
};

/// Map style as stated by a style file. Unset values use the program's defaults.
struct MapLook {
    std::optional<std::string> shipped_table; ///< name of one of class_tables()
    std::optional<OwnClassTable> own_table;
    std::optional<std::string> unit;     ///< "mm/m" or "in/mi"
    std::optional<std::string> theme;    ///< "light", "dark" or "print"
    std::optional<std::string> ramp;     ///< name of a shipped ramp
    std::vector<std::uint32_t> own_ramp; ///< 0xRRGGBB from smooth to rough; empty: not stated
    ThemeColours colours;
    LineFactors lines;
    std::optional<int> min_passes;
    LegendWords words;
};

} // namespace macadam
