#pragma once

#include "app/cli/arguments.hpp"
#include "mapping/routes/shortest_path.hpp"

#include <filesystem>
#include <optional>
#include <utility>

namespace macadam {

/// Roads to report in sections, and the rule that cuts them.
struct SectionOptions {
    std::optional<std::pair<GeoPoint, GeoPoint>> route;
    RouteConfig::Best best;
    std::optional<std::filesystem::path> along;    ///< lines to follow
    std::optional<std::filesystem::path> sections; ///< an agency's own sections
    std::optional<double> length_m;                ///< `std::nullopt`: uncut
    bool homogeneous;
    std::optional<std::filesystem::path> exclude;
    double exclude_radius_m;
};

inline constexpr Option sections_option = in_group(
    "sections",
    {"--sections",
     "FILE",
     "Your own sections: a table (route or way_id, from_m and to_m, or _km, or _mi) or a layer "
     "of lines."});
inline constexpr Option section_length_option =
    in_group("sections",
             {"--section-length",
              "LENGTH",
              "Cut into sections of this length: 100, 0.5km, 0.1mi.",
              "--sections: as given; otherwise 100"});
inline constexpr Option homogeneous_option = in_group(
    "sections",
    {"--homogeneous", "", "Cut where the roughness changes, into sections of at least 200 m."});
inline constexpr Option exclude_option = rare(in_group(
    "sections",
    {"--exclude",
     "FILE",
     "Places to exclude, such as bridges: a table (lat_deg, lon_deg, optional radius_m) or "
     "lines."}));
inline constexpr Option exclude_radius_option = rare(in_group(
    "sections", {"--exclude-radius", "METRES", "Radius around places without radius_m.", "20"}));

/// Parses --route LAT,LON LAT,LON. \throws UsageError
std::optional<std::pair<GeoPoint, GeoPoint>> parse_route(const Arguments& arguments);

/// Parses --sections with its modifiers and, for commands that have them, --route and --along.
/// Returns `std::nullopt` if no sections are requested.
/// \throws UsageError  for invalid values or combinations.
std::optional<SectionOptions> parse_sections(const Arguments& arguments, bool has_routes);

} // namespace macadam
