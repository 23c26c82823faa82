#include "app/render/map_scene.hpp"

#include "app/cli/console.hpp"
#include "app/database/empty_map_message.hpp"
#include "app/database/selection.hpp"
#include "app/render/base_map_option.hpp"
#include "app/render/box_visit.hpp"
#include "app/render/data_parts.hpp"
#include "app/render/line_collector.hpp"
#include "estimator/common/error.hpp"
#include "render/map/sheet_shape.hpp"
#include "storage/store/reader/store_background.hpp"
#include "storage/text/unit_system.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

namespace macadam {
namespace {

constexpr double certain_sd = 0.5; // relative; above it the line has a narrower core

std::string subtitle_of_empty_map(const StoreReader& store) {
    return store.shows_published_alone() ? "No measurements are published yet"
                                         : "No measurements yet: 'macadam import' adds trips";
}

std::string length_text(double km, const MapStyle& style) {
    return style.in_per_mi ? fmt::format("{:.1f} mi", 1000 * km * mi_of_m)
                           : fmt::format("{:.1f} km", km);
}

std::string subtitle_of(const StoreInfo& info, const MapStyle& style) {
    return fmt::format("{}  ·  {}  ·  {}  ·  {}",
                       period_text({info.first_seen_ms, info.last_seen_ms}),
                       length_text(info.km, style),
                       counted(info.trips, "trip"),
                       counted(info.vehicles.size(), "car"));
}

/// Extent, lengths and period of the segments that a map selects.
struct SelectedRoads {
    GeoBox box;
    std::vector<double> class_km; ///< of segments with enough passes
    double km = 0;
    ObservedPeriod seen{};
};

SelectedRoads selected_roads(const StoreReader& store,
                             const SegmentFilter& filter,
                             const ClassTable& classes,
                             int min_passes) {
    SelectedRoads roads{.box = {}, .class_km = std::vector<double>(classes.classes.size())};
    const auto take_time = [](auto& into, const auto& utc_ms, auto better) {
        into = into && utc_ms ? std::optional{better(*into, *utc_ms)} : into ? into : utc_ms;
    };
    store.visit(filter, [&](const SegmentRecord& record) {
        const auto& segment = record.segment;
        const double km = (segment.to_m - segment.from_m) / 1000;
        for (const auto& point : segment.line) {
            roads.box = including(roads.box, point);
        }
        roads.km += km;
        take_time(roads.seen.first_ms, record.state->first_seen_ms, [](auto a, auto b) {
            return std::min(a, b);
        });
        take_time(roads.seen.last_ms, record.state->last_seen_ms, [](auto a, auto b) {
            return std::max(a, b);
        });
        if (!has_few_passes(record.state->passes, min_passes)) {
            roads.class_km[class_index(classes, record.state->iri_um / 1000.0)] += km;
        }
    });
    return roads;
}

/// Returns the events of a filter in a box, in its longitudes where it crosses the antimeridian.
std::vector<MapEvent>
map_events(const StoreReader& store, const SegmentFilter& filter, const GeoBox& box) {
    std::vector<MapEvent> events;
    for (const auto& [event, at, name, highway] : store.events(filter)) {
        const double turn_deg = at.lon_deg + 360 <= box.east_deg ? 360 : 0;
        const GeoPoint place{at.lat_deg, at.lon_deg + turn_deg};
        if (contains(box, place)) {
            events.push_back({place, event.kind, severity_of(event.size_um / 1000.0)});
        }
    }
    return events;
}

const ClassTable& classes_of(const MapRequest& request) {
    return *request.style.classes;
}

/// \throws InputError  if the database has no segment of the way, measured or not.
void expect_way(const StoreReader& store, std::int64_t way_id) {
    SegmentFilter of_way;
    of_way.way_id = way_id;
    of_way.with_state_only = false;
    bool is_there = false;
    store.visit(of_way, [&](const SegmentRecord&) { is_there = true; });
    if (!is_there) {
        throw InputError{
            fmt::format("{}: the network has no way '{}'", store.file().string(), way_id)};
    }
}

/// Builds a scene with its texts, but without lines.
MapScene scene_around(const StoreReader& store, const MapRequest& request) {
    MapScene scene;
    scene.title = request.title;
    scene.projection = request.projection;
    scene.scale_denominator = request.scale_denominator;
    scene.attribution = store.settings().attribution;
    if (request.base) {
        scene.base = request.base;
        scene.attribution = attribution_with(scene.attribution, *request.base);
    }
    const auto with_selection = [&](std::string text) {
        return text + (request.selection.empty() ? "" : "  ·  " + request.selection);
    };
    if (request.filter.box) {
        scene.box = *request.filter.box;
        const auto empty = empty_map_text(store);
        scene.subtitle =
            !empty.empty()
                ? subtitle_of_empty_map(store)
                : with_selection(request.subtitle ? *request.subtitle : period_text(store.seen()));
        return scene;
    }
    if (selects(request.filter) || request.subtitle) {
        const auto& classes =
            request.subtitle ? *class_table(store.settings().class_table) : classes_of(request);
        auto roads = selected_roads(store, request.filter, classes, request.style.min_passes);
        if (is_empty(roads.box)) {
            if (request.filter.way_id) {
                expect_way(store, *request.filter.way_id);
            }
            throw InputError{fmt::format("{}: the selection contains no measured segment, expected "
                                         "at least one",
                                         store.file().string())};
        }
        scene.box = box_with_margin(roads.box);
        scene.data_box = roads.box;
        scene.class_km = request.subtitle ? request.class_km : std::move(roads.class_km);
        scene.subtitle = with_selection(request.subtitle.value_or(fmt::format(
            "{}  ·  {}", period_text(roads.seen), length_text(roads.km, request.style))));
        return scene;
    }
    const auto info = store.info();
    const auto& classes = classes_of(request);
    scene.box = box_with_margin(info.box);
    scene.data_box = info.box;
    scene.subtitle = info.segments_with_passes == 0 ? subtitle_of_empty_map(store)
                                                    : subtitle_of(info, request.style);
    if (request.style.min_passes <= 1 && &classes == class_table(info.settings.class_table)) {
        for (const auto& [name, km] : info.classes) {
            scene.class_km.push_back(km);
        }
    } else {
        scene.class_km = selected_roads(store, {}, classes, request.style.min_passes).class_km;
    }
    return scene;
}

bool holds(const GeoBox& outer, const GeoBox& inner) {
    return outer.west_deg <= inner.west_deg && outer.south_deg <= inner.south_deg &&
           inner.east_deg <= outer.east_deg && inner.north_deg <= outer.north_deg;
}

void expect_roads(const MapPlan& plan) {
    const auto& scene = plan.scene();
    const auto& box = scene.box;
    const auto touches = [&](const MapLine& line) {
        return std::ranges::any_of(line.line, [&](auto& point) { return contains(box, point); });
    };
    if (std::ranges::none_of(scene.lines, touches)) {
        if (scene.scale_denominator > 0) {
            throw InputError{fmt::format("nothing to draw: there is no road within the sheet at "
                                         "1:{:.0f} around {:.5f},{:.5f}, "
                                         "expected a smaller scale, or --bbox around a road",
                                         scene.scale_denominator,
                                         (box.south_deg + box.north_deg) / 2,
                                         (box.west_deg + box.east_deg) / 2)};
        }
        throw InputError{fmt::format(
            "nothing to draw: the database has no road between {:.5f},{:.5f} and {:.5f},{:.5f}",
            box.south_deg,
            box.west_deg,
            box.north_deg,
            box.east_deg)};
    }
}

using SelectedStates = std::map<SegmentKey, SegmentSummary::Roughness>;

/// Returns the states of the selected segments in a box.
SelectedStates
selected_states(const StoreReader& store, const SegmentFilter& filter, const GeoBox& box) {
    SelectedStates states;
    visit_box(store, filter, box, [&](const SegmentRecord& record) {
        const auto& state = *record.state;
        states.emplace(record.segment.key,
                       SegmentSummary::Roughness{state.iri_um, state.sd_um, state.passes});
    });
    return states;
}

/// Returns the numbers of roads by way. Of several the first counts, as on the largest sign. A text
/// that is longer than numbers are, or has no figure (mappers leave notes there), is no number.
std::unordered_map<std::int64_t, std::string> road_numbers(const StoreReader& store) {
    constexpr std::size_t longest = 10;
    std::unordered_map<std::int64_t, std::string> numbers;
    for (const auto& [way_id, ref] : StoreBackground{store}.road_refs()) {
        const auto first = ref.substr(0, ref.find(';'));
        if (first.size() <= longest && first.find_first_of("0123456789") != std::string::npos) {
            numbers.emplace(way_id, first);
        }
    }
    return numbers;
}

} // namespace

std::string period_text(const ObservedPeriod& seen) {
    if (!seen.first_ms || !seen.last_ms) {
        return "dates not known";
    }
    const auto first = utc_day(*seen.first_ms);
    const auto last = utc_day(*seen.last_ms);
    return first == last ? first : first + " to " + last;
}

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

bool has_few_passes(std::int32_t passes, int min_passes) {
    return 0 < passes && passes < min_passes;
}

bool is_certain(IriUm iri_um, IriUm sd_um) {
    return sd_um <= certain_sd * iri_um;
}

std::vector<MapLine> map_lines(const StoreReader& store,
                               const GeoBox& box,
                               const std::function<void(const SegmentRecord&, MapLine&)>& paint,
                               const LineJoining& joining) {
    SegmentFilter all;
    all.with_state_only = false;
    LineCollector lines{joining};
    const auto numbers = road_numbers(store);
    visit_box(store, all, box, [&](const SegmentRecord& record) {
        MapLine line;
        line.line = record.segment.line;
        line.forward = record.segment.key.forward;
        line.rank = rank_of(record.highway);
        line.name = record.name;
        if (const auto found = numbers.find(record.segment.key.way_id); found != numbers.end()) {
            line.number = found->second;
        }
        paint(record, line);
        lines.add(record.segment, std::move(line));
    });
    return std::move(lines).finished();
}

std::vector<MapLine> map_lines(const StoreReader& store,
                               const GeoBox& box,
                               const ClassTable& classes,
                               int min_passes,
                               const SegmentFilter& filter,
                               double scale_denominator) {
    std::optional<SelectedStates> selected;
    if (SegmentFilter others = filter; others.box.reset(), selects(others)) {
        selected = selected_states(store, others, box);
    }
    const auto roughness_of = [&](const SegmentRecord& record) {
        std::optional<SegmentSummary::Roughness> roughness;
        if (selected) {
            if (const auto found = selected->find(record.segment.key); found != selected->end()) {
                roughness = found->second;
            }
        } else if (const auto& state = record.state) {
            roughness = {state->iri_um, state->sd_um, state->passes};
        }
        return roughness;
    };
    const auto paint = [&](const SegmentRecord& record, MapLine& line) {
        if (const auto roughness = roughness_of(record)) {
            line.iri_mm_per_m = roughness->iri_um / 1000.0;
            line.iri_class = static_cast<int>(class_index(classes, line.iri_mm_per_m));
            line.few_passes = has_few_passes(roughness->passes, min_passes);
            line.certain = is_certain(roughness->iri_um, roughness->sd_um);
        }
    };
    return map_lines(store,
                     box,
                     paint,
                     joining_at(scale_denominator, store.settings().segment_length_m, classes));
}

MapPlan load_map(const StoreReader& store, const MapRequest& request, const LoadLines& lines) {
    auto style = request.style;
    auto filter = request.filter;
    filter.box.reset();
    if (selects(filter) && style.words.unmeasured == LegendWords{}.unmeasured) {
        style.words.unmeasured = "Not selected or measured";
    }
    auto scene = scene_around(store, request);
    const bool is_of_all = !request.filter.box && request.scale_denominator <= 0;
    if (request.insets && is_of_all) {
        set_insets(store, request.filter, scene);
    }
    const auto size = size_for(scene, style, request.size, request.other_sizes);
    MapPlan plan{std::move(scene), style, size};
    if (const auto room =
            request.details && is_of_all ? plan.detail_room() : std::optional<DetailRoom>{}) {
        scene = std::move(plan).scene();
        set_details(store, request.filter, *room, scene);
        plan = MapPlan{std::move(scene), style, size};
    }
    if (request.scale_denominator > 0 && !request.filter.box) {
        scene = plan.scene();
        if (centre_on_densest_area(store, request.filter, plan.room(), scene)) {
            plan = MapPlan{std::move(scene), style, size};
        }
    }
    const auto set_background = [&](MapPlan& map, const GeoBox& box, bool with_places) {
        if (request.background) {
            const StoreBackground background{store};
            map.set_background({request.base ? std::vector<BackgroundTile>{}
                                             : background.tiles(map.background_level(), box),
                                with_places ? background.places(box) : std::vector<PlaceName>{}});
        }
    };
    const auto load = [&](MapPlan& map) {
        const auto box = map.ground();
        const auto& level = map.background_level();
        set_background(map, box, true);
        map.set_roads(lines ? lines(box, map.scale())
                            : map_lines(store,
                                        box,
                                        classes_of(request),
                                        request.style.min_passes,
                                        filter,
                                        map.scale()),
                      request.events ? map_events(store, filter, box) : std::vector<MapEvent>{});
        if (&map.background_level() != &level) {
            set_background(map, box, true); // the legend made the map smaller
        }
        return box;
    };
    const auto ground = load(plan);
    if (!holds(ground, plan.ground())) {
        load(plan);
    }
    for (auto& inset : plan.insets()) {
        load(inset);
    }
    if (auto* const locator = plan.locator()) {
        set_background(*locator, locator->ground(), false);
    }
    expect_roads(plan);
    return plan;
}

} // namespace macadam
