#include "storage/networks/background/osm_background_tags.hpp"

#include "estimator/common/exact_number.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace macadam {
namespace {

struct TagKind {
    std::string_view key, value;
    BackgroundKind kind;
};

// The first that applies counts. Source of the values: OSM wiki, page Map features.
constexpr std::array area_kinds{
    TagKind{"natural", "water", BackgroundKind::water},
    TagKind{"landuse", "reservoir", BackgroundKind::water},
    TagKind{"landuse", "basin", BackgroundKind::water},
    TagKind{"waterway", "riverbank", BackgroundKind::water},
    TagKind{"waterway", "dock", BackgroundKind::water},
    TagKind{"natural", "wood", BackgroundKind::forest},
    TagKind{"landuse", "forest", BackgroundKind::forest},
    TagKind{"leisure", "park", BackgroundKind::park},
    TagKind{"leisure", "golf_course", BackgroundKind::park},
    TagKind{"landuse", "village_green", BackgroundKind::park},
    TagKind{"landuse", "recreation_ground", BackgroundKind::park},
    TagKind{"landuse", "cemetery", BackgroundKind::park},
    TagKind{"landuse", "allotments", BackgroundKind::park},
    TagKind{"landuse", "meadow", BackgroundKind::meadow},
    TagKind{"landuse", "grass", BackgroundKind::meadow},
    TagKind{"landuse", "orchard", BackgroundKind::meadow},
    TagKind{"landuse", "vineyard", BackgroundKind::meadow},
    TagKind{"natural", "grassland", BackgroundKind::meadow},
    TagKind{"natural", "heath", BackgroundKind::meadow},
    TagKind{"landuse", "residential", BackgroundKind::built_up},
    TagKind{"landuse", "commercial", BackgroundKind::built_up},
    TagKind{"landuse", "retail", BackgroundKind::built_up},
    TagKind{"landuse", "industrial", BackgroundKind::built_up},
};

bool is_set(const OsmTags& tags, const char* key) {
    const auto set = value(tags, key);
    return !set.empty() && set != "no";
}

} // namespace

std::optional<BackgroundKind> area_kind_of(const OsmTags& tags) {
    if (is_set(tags, "building")) {
        const bool is_below = value(tags, "location") == "underground";
        return is_below ? std::nullopt : std::optional{BackgroundKind::building};
    }
    const auto* const found =
        std::find_if(area_kinds.begin(), area_kinds.end(), [&](const TagKind& kind) {
            return value(tags, kind.key.data()) == kind.value;
        });
    return found == area_kinds.end() ? std::nullopt : std::optional{found->kind};
}

std::optional<BackgroundKind> line_kind_of(const OsmTags& tags) {
    if (is_set(tags, "tunnel") || value(tags, "area") == "yes") {
        return std::nullopt;
    }
    const auto waterway = value(tags, "waterway");
    if (is_one_of(waterway, {"river", "canal"})) {
        return BackgroundKind::river;
    }
    if (waterway == "stream") {
        return BackgroundKind::stream;
    }
    if (is_one_of(value(tags, "railway"), {"rail", "light_rail", "narrow_gauge", "funicular"})) {
        return is_set(tags, "service") ? BackgroundKind::siding : BackgroundKind::railway;
    }
    return std::nullopt;
}

bool is_coastline(const OsmTags& tags) {
    return value(tags, "natural") == "coastline";
}

bool is_multipolygon(const OsmTags& tags) {
    return value(tags, "type") == "multipolygon";
}

std::optional<PlaceRank> place_rank_of(const OsmTags& tags) {
    const auto place = value(tags, "place");
    return place == "city"      ? std::optional{PlaceRank::city}
           : place == "town"    ? std::optional{PlaceRank::town}
           : place == "village" ? std::optional{PlaceRank::village}
           : place == "suburb"  ? std::optional{PlaceRank::suburb}
                                : std::nullopt;
}

std::int64_t population_of(const OsmTags& tags) {
    constexpr std::int64_t most = 100'000'000;
    const auto population = exact_number<std::int64_t>(value(tags, "population"));
    return population ? std::clamp<std::int64_t>(*population, 0, most) : 0;
}

} // namespace macadam
