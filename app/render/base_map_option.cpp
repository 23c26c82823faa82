#include "app/render/base_map_option.hpp"

#include "storage/rasters/base_map_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

bool has_colour(const std::vector<std::uint8_t>& rgba) {
    for (std::size_t at = 3; at < rgba.size(); at += 4) {
        if (rgba[at] != 0) {
            return true;
        }
    }
    return false;
}

} // namespace

std::optional<BaseMapChoice> parse_base_map(const Arguments& arguments) {
    const auto opacity = arguments.number("--base-opacity");
    if (opacity && !(*opacity >= 0 && *opacity <= 1)) {
        throw UsageError{fmt::format("--base-opacity is {}, expected 0 to 1", *opacity)};
    }
    const auto file = arguments.value("--base");
    if (!file && opacity) {
        throw UsageError{"--base-opacity requires --base, expected a base map"};
    }
    return file ? std::optional{BaseMapChoice{*file, opacity}} : std::nullopt;
}

WatchedBaseMap opened_base_map(const std::filesystem::path& file) {
    auto map = std::make_shared<BaseMap>(open_base_map(file));
    auto is_seen = std::make_shared<bool>(false);
    map->laid_on = [laid_on = std::move(map->laid_on), is_seen](const PicturePlane& plane) {
        return [paint = laid_on(plane), is_seen](const PicturePart& part) {
            auto rgba = paint(part);
            *is_seen = *is_seen || has_colour(rgba);
            return rgba;
        };
    };
    return {std::move(map), std::move(is_seen)};
}

std::string attribution_with(const std::string& of_roads, const BaseMap& base) {
    constexpr std::string_view between = "  ·  ";
    const auto is_part = [&](std::string_view rest) {
        while (!rest.empty()) {
            const auto end = rest.find(between);
            if (rest.substr(0, end) == base.attribution) {
                return true;
            }
            rest.remove_prefix(end == rest.npos ? rest.size() : end + between.size());
        }
        return false;
    };
    if (base.attribution.empty() || is_part(of_roads)) {
        return of_roads;
    }
    return of_roads.empty() ? fmt::format("Base map: {}", base.attribution)
                            : fmt::format("{}{}Base map: {}", of_roads, between, base.attribution);
}

} // namespace macadam
