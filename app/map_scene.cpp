#include "app/map_scene.hpp"

#include "app/console.hpp"
#include "app/map_box.hpp"
#include "estimator/common/error.hpp"
#include "mapping/antimeridian.hpp"
#include "storage/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace macadam {
namespace {

constexpr double margin_share = 0.05; // of the driven extent, so that nothing touches the frame
constexpr double least_margin_m = 50;
constexpr double certain_sd = 0.5; // of the value; beyond it the line is drawn with a narrower core

GeoBox box_with_margin(const GeoBox& box) {
    const double diagonal_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg});
    return grown(box, std::max(least_margin_m, margin_share * diagonal_m));
}

/// More than the box: what a picture of another shape than the box also shows, with the room that
/// it makes for the legend. What lies outside the picture is cut off by it.
GeoBox shown_around(const GeoBox& box) {
    return grown_over(
        box, 1.5 * distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}));
}

/// \param whole  the picture shows all of the store, so its numbers are the picture's.
std::string subtitle_of(const StoreInfo& info, bool whole) {
    std::string period = "dates not known";
    if (info.first_seen_ms && info.last_seen_ms) {
        const auto first = utc_text(*info.first_seen_ms).substr(0, 10);
        const auto last = utc_text(*info.last_seen_ms).substr(0, 10);
        period = first == last ? first : first + " to " + last;
    }
    if (!whole) {
        return period;
    }
    return fmt::format("{}  ·  {:.1f} km  ·  {}  ·  {}",
                       period,
                       info.km,
                       counted(info.trips, "trip"),
                       counted(info.vehicles.size(), "car"));
}

/// Of all the store's segments with enough passes.
std::vector<double>
class_km_of(const RoadStore& store, const ClassTable& classes, int least_passes) {
    std::vector<double> km(classes.classes.size());
    store.visit({}, [&](const SegmentRecord& record) {
        if (record.state && !has_few_passes(record.state->passes, least_passes)) {
            const auto& segment = record.segment;
            km[class_index(classes, record.state->iri_um / 1000.0)] +=
                (segment.to_m - segment.from_m) / 1000;
        }
    });
    return km;
}

} // namespace

int rank_of(std::string_view highway) {
    struct Rank {
        std::string_view prefix;
        int rank;
    };
    constexpr std::array ranks{Rank{"motorway", 0},
                               Rank{"trunk", 0},
                               Rank{"primary", 1},
                               Rank{"secondary", 2},
                               Rank{"tertiary", 3},
                               Rank{"service", 5},
                               Rank{"track", 5}};
    const auto found =
        std::ranges::find_if(ranks, [&](const Rank& r) { return highway.starts_with(r.prefix); });
    return found != ranks.end() ? found->rank : highway.empty() ? 2 : 4;
}

bool has_few_passes(std::int32_t passes, int least_passes) {
    return 0 < passes && passes < least_passes;
}

bool is_certain(IriUm iri_um, IriUm sd_um) {
    return sd_um <= certain_sd * iri_um;
}

std::vector<MapLine>
map_lines(const RoadStore& store, const GeoBox& box, const ClassTable& classes, int least_passes) {
    // Each direction is a segment of its own; what was driven one way only is still a road of two
    // sides where the map lets cars go both ways.
    std::map<std::pair<std::int64_t, std::uint32_t>, int> directions;
    SegmentFilter filter;
    filter.with_state_only = false;
    visit_box(store, filter, box, [&](const SegmentRecord& record) {
        ++directions[{record.segment.key.way_id, record.segment.key.index}];
    });
    std::vector<MapLine> lines;
    visit_box(store, filter, box, [&](const SegmentRecord& record) {
        const auto& key = record.segment.key;
        MapLine line;
        line.line = record.segment.line;
        line.forward = key.forward;
        line.both_ways = directions.at({key.way_id, key.index}) == 2;
        line.rank = rank_of(record.highway);
        line.name = record.name;
        if (record.state) {
            line.iri_class = static_cast<int>(class_index(classes, record.state->iri_um / 1000.0));
            line.few_passes = has_few_passes(record.state->passes, least_passes);
            line.certain = is_certain(record.state->iri_um, record.state->sd_um);
        }
        lines.push_back(std::move(line));
    });
    return lines;
}

MapScene map_scene(const RoadStore& store,
                   const std::optional<GeoBox>& box,
                   const ClassTable& classes,
                   const std::string& title,
                   int least_passes) {
    const auto info = store.info();
    MapScene scene;
    scene.box = box ? *box : box_with_margin(info.box);
    scene.title = title;
    scene.subtitle = subtitle_of(info, !box);
    scene.attribution = info.settings.attribution;

    if (!box && least_passes <= 1 && &classes == class_table(info.settings.class_table)) {
        for (const auto& [name, km] : info.classes) {
            scene.class_km.push_back(km);
        }
    } else if (!box) {
        scene.class_km = class_km_of(store, classes, least_passes);
    }

    scene.lines = map_lines(store, shown_around(scene.box), classes, least_passes);
    if (std::ranges::none_of(scene.lines, [&](const MapLine& line) {
            return std::ranges::any_of(line.line,
                                       [&](auto& point) { return contains(scene.box, point); });
        })) {
        throw InputError{fmt::format(
            "nothing to draw: the store has no road between {:.5f},{:.5f} and {:.5f},{:.5f}",
            scene.box.south_deg,
            scene.box.west_deg,
            scene.box.north_deg,
            scene.box.east_deg)};
    }
    return scene;
}

} // namespace macadam
