#include "app/report_values.hpp"

#include "app/map_scene.hpp"
#include "app/section_query.hpp"
#include "app/stretch_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/network_file.hpp"
#include "storage/utc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace macadam {
namespace {

constexpr double histogram_step_mm_per_m = 0.25;
constexpr double least_histogram_mm_per_m = 4;
constexpr double most_histogram_mm_per_m = 12;

constexpr int map_width_px = 1400;
constexpr int least_map_height_px = 875;
constexpr int most_map_height_px = 1250;
constexpr int stretch_width_px = 480;
constexpr int stretch_height_px = 360;
constexpr double least_margin_m = 60; // around a stretch: the next side streets
constexpr double margin_share = 0.25; // of its extent

/// What the store says of its network: the measured segments, and how long all of it is.
struct Survey {
    std::vector<SegmentRecord> measured;
    std::map<std::string, double> network_m; ///< by highway tag
};

Survey survey_of(const RoadStore& store) {
    Survey survey;
    SegmentFilter filter;
    filter.with_state_only = false;
    store.visit(filter, [&](const SegmentRecord& record) {
        survey.network_m[record.highway] += record.segment.to_m - record.segment.from_m;
        if (record.state) {
            survey.measured.push_back(record);
        }
    });
    return survey;
}

/// As long as all but the roughest percent need.
std::size_t histogram_bins(const std::vector<SegmentRecord>& measured) {
    std::vector<RatedLength> pieces;
    pieces.reserve(measured.size());
    for (const auto& record : measured) {
        pieces.push_back(rated_length(record));
    }
    const double most = pieces.empty() ? 0 : road_percentile(std::move(pieces), 0.99);
    return static_cast<std::size_t>(
        std::clamp(std::ceil(most), least_histogram_mm_per_m, most_histogram_mm_per_m) /
        histogram_step_mm_per_m);
}

std::string period_of(std::optional<std::int64_t> first_ms, std::optional<std::int64_t> last_ms) {
    if (!first_ms || !last_ms) {
        return {};
    }
    const auto first = utc_text(*first_ms).substr(0, 10);
    const auto last = utc_text(*last_ms).substr(0, 10);
    return first == last ? first : first + " to " + last;
}

// ------------------------------------------------------------------------------------- pictures

MapStyle unadorned(MapStyle style) {
    style.legend = false; // the page has it
    return style;
}

ReportPicture picture_of(const MapScene& scene, MapStyle style, int width_px, int height_px) {
    style = unadorned(style);
    ReportPicture picture{{}, {}, width_px, height_px};
    style.theme = MapStyle::Theme::light;
    picture.light_png = encode_png(render_map(scene, style, width_px, height_px));
    style.theme = MapStyle::Theme::dark;
    picture.dark_png = encode_png(render_map(scene, style, width_px, height_px));
    return picture;
}

/// As high as a box needs at the map's width, within what suits a page.
int map_height_for(const GeoBox& box) {
    const double middle_deg = (box.south_deg + box.north_deg) / 2;
    const double width_m = distance_m({middle_deg, box.west_deg}, {middle_deg, box.east_deg});
    const double height_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.west_deg});
    return std::clamp(static_cast<int>(map_width_px * height_m / std::max(width_m, 1.0)),
                      least_map_height_px,
                      most_map_height_px);
}

MapScene whole_map(const RoadStore& store, const ClassTable& classes) {
    auto scene = map_scene(store, std::nullopt, classes, "");
    scene.subtitle.clear();    // the page says it
    scene.attribution.clear(); // likewise
    scene.scale_bar = false;   // likewise, in letters that a phone shows as large as all others
    return scene;
}

GeoBox box_around(const RoadStretch& stretch) {
    GeoBox box;
    for (const auto& point : stretch.line) {
        box = including(box, point);
    }
    const double extent_m =
        distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg});
    return grown(box, std::max(least_margin_m, margin_share * extent_m));
}

/// The stretch alone in the colours of its segments, all other roads quiet: what is meant is seen
/// at a glance.
MapScene scene_of(const RoadStore& store,
                  const RoadStretch& stretch,
                  const std::vector<SegmentRecord>& measured,
                  const ClassTable& classes) {
    MapScene scene;
    scene.scale_bar = false; // too small to read on a phone; the page says how long the stretch is
    scene.box = box_around(stretch);
    const auto around = grown(scene.box,
                              distance_m({scene.box.south_deg, scene.box.west_deg},
                                         {scene.box.north_deg, scene.box.east_deg}));
    scene.lines = map_lines(store, around, classes);
    for (auto& line : scene.lines) {
        line.iri_class = -1;
    }
    for (const auto i : stretch.records) {
        MapLine line;
        line.line = measured[i].segment.line;
        line.iri_class = static_cast<int>(class_index(classes, rated_length(measured[i]).iri));
        scene.lines.push_back(std::move(line));
    }
    return scene;
}

// --------------------------------------------------------------------------------------- values

std::string spoken_model(const std::string& model) {
    return model == own_file_model ? model : "built-in " + model;
}

std::vector<ReportVehicle> vehicles_of(const RoadStore& store) {
    std::vector<ReportVehicle> vehicles;
    for (const auto& use : store.vehicle_uses()) {
        vehicles.push_back({.name = use.vehicle,
                            .model = spoken_model(use.vehicle_model),
                            .method = use.method,
                            .trips = use.trips,
                            .undated_trips = use.undated_trips,
                            .passes = use.passes,
                            .km = use.km,
                            .matched_km = use.matched_km,
                            .rows_read = use.rows_read,
                            .rows_used = use.rows_used});
    }
    std::ranges::stable_sort(vehicles, std::ranges::greater{}, &ReportVehicle::km);
    return vehicles;
}

/// "123456 from 100 to 240 m": as driven, so metres fall where the way is driven against.
std::string spoken_reference(const RoadStretch& stretch) {
    std::vector<std::string> parts;
    for (const auto& [way_id, forward, from_m, to_m] : stretch.parts) {
        parts.push_back(fmt::format("{} from {:.0f} to {:.0f} m",
                                    way_id,
                                    forward ? from_m : to_m,
                                    forward ? to_m : from_m));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<ReportSection> sections_of(const RoadStore& store, const SectionOptions& options) {
    std::vector<ReportSection> sections;
    each_section(store, options, {}, [&](const NamedSection& named) {
        sections.push_back({.name = named.name,
                            .from_m = named.from_m,
                            .to_m = named.to_m,
                            .excluded_m = named.section.excluded_m,
                            .open_share = named.section.open_share,
                            .measured = named.section.measured});
    });
    return sections;
}

void stop_if_wanted(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped before the report was whole"};
    }
}

} // namespace

Report report_of(const RoadStore& store, const ReportConfig& config, const Progress& progress) {
    const auto& classes = *config.style.classes;
    const auto info = store.info();
    const auto survey = survey_of(store);
    RoadStretchConfig poor;
    poor.above_mm_per_m = poor_above(classes);
    auto stretches = worst_stretches(kept_roads(store), survey.measured, poor);

    Report report;
    report.title = config.title;
    report.period = period_of(info.first_seen_ms, info.last_seen_ms);
    report.network_source = info.settings.network_source;
    report.attribution = info.settings.attribution;
    report.segment_length_m = info.settings.segment_length_m;
    report.classes = &classes;
    report.colours = ramp_colours(config.style.ramp, classes.classes.size());
    report.summary = network_summary(survey.measured, survey.network_m, classes);
    report.histogram = iri_histogram(
        survey.measured, classes, histogram_step_mm_per_m, histogram_bins(survey.measured));
    report.segments = info.segments;
    report.segments_with_passes = survey.measured.size();
    report.poor_above_mm_per_m = poor.above_mm_per_m;
    report.least_stretch_m = poor.least_length_m;
    report.stretches = stretches.size();
    for (const auto& stretch : stretches) {
        report.stretches_m += stretch.length_m;
    }
    if (config.sections) {
        report.sections = sections_of(store, *config.sections);
    }
    report.vehicles = vehicles_of(store);
    report.quality = data_quality(survey.measured);
    report.lateral_passes = info.lateral_passes;
    report.row_reasons = store.row_reasons();

    stretches.resize(std::min(stretches.size(), config.worst));
    const auto pictures = stretches.size() + 1;
    const auto map = whole_map(store, classes);
    const int map_height_px = map_height_for(map.box);
    report.map = picture_of(map, config.style, map_width_px, map_height_px);
    report.map_width_m = ground_width_m(map, unadorned(config.style), map_width_px, map_height_px);
    for (auto& stretch : stretches) {
        stop_if_wanted(progress);
        progress(report.worst.size() + 1, pictures);
        const auto scene = scene_of(store, stretch, survey.measured, classes);
        report.worst.push_back(
            {.stretch = stretch,
             .heading = std::string{heading_of(stretch)},
             .reference = spoken_reference(stretch),
             .seen = period_of(stretch.first_seen_ms, stretch.last_seen_ms),
             .map = picture_of(scene, config.style, stretch_width_px, stretch_height_px)});
    }
    progress(pictures, pictures);
    return report;
}

} // namespace macadam
