#pragma once

#include "mapping/style/custom_class_table.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Colours of all that is not a class, 0xRRGGBB; nothing: the theme's.
struct ThemeColours {
    std::optional<std::uint32_t> page;       ///< under title, scale bar and legend
    std::optional<std::uint32_t> ground;     ///< under the roads
    std::optional<std::uint32_t> border;     ///< hairlines
    std::optional<std::uint32_t> ink;        ///< text that counts
    std::optional<std::uint32_t> quiet_ink;  ///< text that does not
    std::optional<std::uint32_t> casing;     ///< beside every measured road
    std::optional<std::uint32_t> unmeasured; ///< roads nobody drove
    std::optional<std::uint32_t> few_passes; ///< roads driven too seldom
};

/// Of what the map would have at its scale.
struct LineFactors {
    double width = 1;
    double casing = 1;
};

/// Words of the legend. In `few_passes` {} stands for the number of passes, in the words of values
/// for the value.
struct LegendWords {
    std::optional<std::string> title; ///< nothing: "Roughness, IRI in" and the unit
    std::string few_passes = "Fewer than {} passes";
    std::string uncertain = "Uncertain";
    std::string unmeasured = "No measurement";
    std::string below = "below {}";
    std::string up_to = "up to {}";
    std::string from = "from {}";
    std::string above = "above {}";
    std::string all = "all";
};

/// How a map is to look, as a style file states it. What it leaves out is as the program has it.
struct MapLook {
    std::optional<std::string> shipped_table; ///< name of one of class_tables()
    std::optional<OwnClassTable> own_table;
    std::optional<std::string> unit;     ///< "mm/m" or "in/mi"
    std::optional<std::string> theme;    ///< "light", "dark" or "print"
    std::optional<std::string> ramp;     ///< name of a shipped one
    std::vector<std::uint32_t> own_ramp; ///< 0xRRGGBB from smooth to rough; empty: not stated
    ThemeColours colours;
    LineFactors lines;
    std::optional<int> min_passes;
    LegendWords words;
};

} // namespace macadam
