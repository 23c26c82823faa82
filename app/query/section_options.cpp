#include "app/query/section_options.hpp"

#include "app/query/query_options.hpp"

#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace macadam {
namespace {

constexpr double profile_m = 100; // usual reporting length of road administrations

std::optional<std::filesystem::path> file_of(const Arguments& arguments, std::string_view name) {
    const auto file = arguments.value(name);
    return file ? std::optional{std::filesystem::path{*file}} : std::nullopt;
}

GeoPoint place_in(const std::string& text) {
    const auto comma = text.find(',');
    const auto lat = parse_number(std::string_view{text}.substr(0, comma));
    const auto lon = comma == std::string::npos
                         ? std::nullopt
                         : parse_number(std::string_view{text}.substr(comma + 1));
    if (!lat || !lon) {
        throw UsageError{fmt::format("--route has '{}', expected LAT,LON in degrees", text)};
    }
    return parse_place("--route", {*lat, *lon});
}

/// Parses a length: "100", "100m", "0.5km", "0.1mi".
std::optional<double> parse_length_m(const Arguments& arguments) {
    constexpr double shortest_m = 1, longest_m = 1e6;
    struct Unit {
        std::string_view name;
        double in_m;
    };
    constexpr std::array units{Unit{"km", 1000}, Unit{"mi", 1609.344}, Unit{"m", 1}, Unit{"", 1}};
    const auto text = arguments.value("--section-length");
    if (!text) {
        return std::nullopt;
    }
    for (const auto& unit : units) {
        if (text->ends_with(unit.name)) {
            const auto number =
                parse_number(std::string_view{*text}.substr(0, text->size() - unit.name.size()));
            const double length_m = number.value_or(0) * unit.in_m;
            if (length_m >= shortest_m && length_m <= longest_m) {
                return length_m;
            }
            break;
        }
    }
    throw UsageError{fmt::format(
        "--section-length is '{}', expected 1 m to 1000 km, such as 100, 0.5km or 0.1mi", *text)};
}

double parse_radius_m(const Arguments& arguments) {
    constexpr double usual_m = 20; // a crossing or the joint of a bridge, plus the error of a fix
    const double radius_m = arguments.number("--exclude-radius", usual_m);
    if (!(radius_m >= 0 && radius_m <= 10'000)) {
        throw UsageError{fmt::format("--exclude-radius is {}, expected 0 to 10000 m", radius_m)};
    }
    return radius_m;
}

/// Rejects options that modify sections if there are none.
void expect_none(const Arguments& arguments, bool has_routes) {
    for (const auto* const name :
         {"--section-length", "--homogeneous", "--exclude", "--exclude-radius"}) {
        if (arguments.flag(name)) {
            throw UsageError{fmt::format(
                "{} requires --sections FILE{}", name, has_routes ? ", --route or --along" : "")};
        }
    }
    if (has_routes && arguments.flag("--shortest")) {
        throw UsageError{"--shortest requires --route LAT,LON LAT,LON"};
    }
}

} // namespace

std::optional<std::pair<GeoPoint, GeoPoint>> parse_route(const Arguments& arguments) {
    const auto places = arguments.values("--route");
    if (places.empty()) {
        return std::nullopt;
    }
    if (places.size() != 2) {
        throw UsageError{
            fmt::format("--route has {} points, expected two: LAT,LON LAT,LON", places.size())};
    }
    return std::pair{place_in(places[0]), place_in(places[1])};
}

std::optional<SectionOptions> parse_sections(const Arguments& arguments, bool has_routes) {
    SectionOptions options{.route = has_routes ? parse_route(arguments) : std::nullopt,
                           .best = has_routes && arguments.flag("--shortest")
                                       ? RouteConfig::Best::shortest
                                       : RouteConfig::Best::quickest,
                           .along = has_routes ? file_of(arguments, "--along") : std::nullopt,
                           .sections = file_of(arguments, "--sections"),
                           .length_m = parse_length_m(arguments),
                           .homogeneous = arguments.flag("--homogeneous"),
                           .exclude = file_of(arguments, "--exclude"),
                           .exclude_radius_m = parse_radius_m(arguments)};
    const int asked =
        (options.route ? 1 : 0) + (options.along ? 1 : 0) + (options.sections ? 1 : 0);
    if (asked == 0) {
        expect_none(arguments, has_routes);
        return std::nullopt;
    }
    if (asked > 1) {
        throw UsageError{"--route, --along and --sections cannot be combined, expected one of "
                         "them"};
    }
    if (options.length_m && options.homogeneous) {
        throw UsageError{"--section-length and --homogeneous cannot be combined, expected one "
                         "of them"};
    }
    if (!options.route && has_routes && arguments.flag("--shortest")) {
        throw UsageError{"--shortest requires --route LAT,LON LAT,LON"};
    }
    if (!options.sections && !options.length_m && !options.homogeneous) {
        options.length_m = profile_m;
    }
    return options;
}

} // namespace macadam
