#include "app/report_values.hpp"

#include "app/map_scene.hpp"
#include "app/section_query.hpp"
#include "app/stretch_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/network_file.hpp"
#include "storage/utc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>
#include <span>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr std::string_view traced_source = "traced from the trips"; // StoreSettings

constexpr double histogram_step_mm_per_m = 0.25;
constexpr double least_histogram_mm_per_m = 4;
constexpr double most_histogram_mm_per_m = 12;

/// Sizes of the pictures.
struct PictureSizes {
    int map_width_px;
    int stretch_width_px;
};
constexpr PictureSizes on_screen{1400, 480};
constexpr PictureSizes on_paper{2100, 700}; // 300 dots an inch on A4, of which three stretches
                                            // share the width
constexpr double least_map_shape = 0.625;   // height by width
constexpr double most_map_shape = 0.893;

// A picture of the highest shape shows at least what lower ones show of the same box.
constexpr int most_width_px = 1120, most_height_px = 1000;
constexpr double stretch_shape = 0.75;
constexpr std::size_t most_changed = 10; // stretches of each kind
constexpr double least_margin_m = 60;    // around a stretch: the next side streets
constexpr double margin_share = 0.25;    // of its extent

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

std::string day_of(std::int64_t utc_ms) {
    return utc_text(utc_ms).substr(0, 10);
}

ReportDays days_of(std::optional<std::int64_t> first_ms, std::optional<std::int64_t> last_ms) {
    return first_ms && last_ms ? ReportDays{day_of(*first_ms), day_of(*last_ms)} : ReportDays{};
}

// ------------------------------------------------------------------------------------- pictures

MapStyle unadorned(MapStyle style) {
    style.legend = false; // the page has it
    return style;
}

/// Draws pictures of a report, and tells how far it is.
class Pictures {
public:
    Pictures(const ReportConfig& config, const Progress& progress, std::size_t count)
        : style_{unadorned(config.style)}, use_{config.pictures}, progress_{progress}, count_{
                                                                                           count} {}

    /// \param classes  how many classes the scene's lines have: null as the report's.
    ReportPicture
    draw(const MapScene& scene, int width_px, int height_px, const ClassTable* classes) {
        if (progress_.stop.stop_requested()) {
            throw InputError{"stopped before the report was whole"};
        }
        progress_(++drawn_, count_);
        auto style = style_;
        style.classes = classes != nullptr ? classes : style.classes;
        const auto png = [&](MapStyle::Theme theme) {
            style.theme = theme;
            return encode_png(render_map(scene, style, width_px, height_px));
        };
        using enum MapStyle::Theme;
        return use_ == PictureUse::paper
                   ? ReportPicture{png(print), {}, width_px, height_px}
                   : ReportPicture{png(light), png(dark), width_px, height_px};
    }

    ReportPicture map(const MapScene& scene, const ClassTable* classes = nullptr) {
        return draw(scene, sizes().map_width_px, map_height_px(scene.box), classes);
    }

    ReportPicture stretch(const MapScene& scene, const ClassTable* classes = nullptr) {
        const int width_px = sizes().stretch_width_px;
        return draw(scene, width_px, static_cast<int>(width_px * stretch_shape), classes);
    }

    /// Of the ground, from side to side of a map.
    double map_width_m(const MapScene& scene) const {
        return ground_width_m(scene, style_, sizes().map_width_px, map_height_px(scene.box));
    }

private:
    const PictureSizes& sizes() const { return use_ == PictureUse::paper ? on_paper : on_screen; }

    /// As high as a box needs at the map's width, within what suits a page.
    int map_height_px(const GeoBox& box) const {
        const double middle_deg = (box.south_deg + box.north_deg) / 2;
        const double width_m = distance_m({middle_deg, box.west_deg}, {middle_deg, box.east_deg});
        const double height_m =
            distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg});
        const double shape =
            std::clamp(height_m / std::max(width_m, 1.0), least_map_shape, most_map_shape);
        return static_cast<int>(sizes().map_width_px * shape);
    }

    MapStyle style_;
    PictureUse use_;
    const Progress& progress_;
    std::size_t count_;
    std::size_t drawn_ = 0;
};

MapScene whole_map(const RoadStore& store, const ClassTable& classes) {
    MapRequest request{.width_px = most_width_px, .height_px = most_height_px};
    request.style.classes = &classes;
    request.style.legend = false; // the page has its own
    auto scene = map_scene(store, request);
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

/// Around a stretch, with all roads quiet.
MapScene
quiet_scene(const RoadStore& store, const RoadStretch& stretch, const ClassTable& classes) {
    MapScene scene;
    scene.scale_bar = false; // too small to read on a phone; the page says how long the stretch is
    scene.box = box_around(stretch);
    const auto around = grown(scene.box,
                              distance_m({scene.box.south_deg, scene.box.west_deg},
                                         {scene.box.north_deg, scene.box.east_deg}));
    scene.lines = map_lines(store, around, classes);
    for (auto& line : scene.lines) {
        line.iri_class = -1;
        line.name.clear(); // too small to read, and the words beside say where it is
    }
    return scene;
}

/// The stretch alone in the colours of its segments, all other roads quiet: what is meant is seen
/// at a glance.
MapScene scene_of(const RoadStore& store,
                  const RoadStretch& stretch,
                  const std::vector<SegmentRecord>& measured,
                  const ClassTable& classes) {
    auto scene = quiet_scene(store, stretch, classes);
    for (const auto i : stretch.records) {
        MapLine line;
        line.line = measured[i].segment.line;
        line.iri_class = static_cast<int>(class_index(classes, rated_length(measured[i]).iri));
        scene.lines.push_back(std::move(line));
    }
    return scene;
}

// --------------------------------------------------------------------------------------- values

std::vector<ReportVehicle> vehicles_of(const RoadStore& store) {
    std::vector<ReportVehicle> vehicles;
    for (const auto& use : store.vehicle_uses()) {
        vehicles.push_back({.name = use.vehicle,
                            .model = use.vehicle_model == own_file_model ? "" : use.vehicle_model,
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

// --------------------------------------------------------------------------------------- change

std::vector<SegmentRecord> states_in(const RoadStore& store, const Period& period) {
    SegmentFilter filter;
    filter.period = period;
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

/// What a road has become, as classes of a map, from blue to red.
const ClassTable& verdicts() {
    constexpr double none = std::numeric_limits<double>::infinity();
    static constexpr std::array classes{IriClass{"improved", 0, false},
                                        IriClass{"no change shown", 0, false},
                                        IriClass{"deteriorated", none, false}};
    static const ClassTable table{"change", "Change", classes};
    return table;
}

constexpr int middle_rank = 3; // a width that suits town streets and main roads

/// The compared segments over a scene whose roads are made quiet.
void colour_change(MapScene& scene,
                   std::span<const ComparedSegment> segments,
                   std::span<const SegmentRecord> since) {
    std::map<std::pair<std::int64_t, std::uint32_t>, int> directions;
    for (const auto& segment : segments) {
        const auto& key = since[segment.after].segment.key;
        ++directions[{key.way_id, key.index}];
    }
    for (auto& line : scene.lines) {
        line.iri_class = -1;
    }
    for (const auto& segment : segments) {
        const auto& of = since[segment.after].segment;
        MapLine line;
        line.line = of.line;
        line.iri_class = static_cast<int>(segment.verdict);
        line.forward = of.key.forward;
        line.both_ways = directions.at({of.key.way_id, of.key.index}) == 2;
        line.rank = middle_rank;
        scene.lines.push_back(std::move(line));
    }
}

std::vector<ReportChangedStretch> drawn(const RoadStore& store,
                                        const std::vector<ChangedStretch>& stretches,
                                        const ChangeSince& change,
                                        std::span<const SegmentRecord> since,
                                        Pictures& pictures) {
    std::vector<ReportChangedStretch> listed;
    for (const auto& stretch : stretches | std::views::take(most_changed)) {
        std::vector<ComparedSegment> segments;
        for (const auto i : stretch.stretch.records) {
            segments.push_back(change.segments[i]);
        }
        auto scene = quiet_scene(store, stretch.stretch, verdicts());
        colour_change(scene, segments, since);
        listed.push_back({stretch,
                          std::string{heading_of(stretch.stretch)},
                          pictures.stretch(scene, &verdicts())});
    }
    return listed;
}

std::size_t pictures_of(const ChangeSince& change) {
    return 1 + std::min(change.worse.size(), most_changed) +
           std::min(change.better.size(), most_changed);
}

/// States before and since, and what they say together.
struct Compared {
    std::vector<SegmentRecord> since;
    ChangeSince change;
};

std::optional<Compared>
compared(const RoadStore& store, const RoadNetwork& roads, const ReportConfig& config) {
    if (!config.since_ms) {
        return std::nullopt;
    }
    const auto before = states_in(store, {std::nullopt, config.since_ms});
    auto since = states_in(store, {config.since_ms, std::nullopt});
    auto change = change_since(roads, before, since, {});
    return Compared{std::move(since), std::move(change)};
}

ReportChange change_of(const RoadStore& store,
                       const Compared& compared,
                       const ReportConfig& config,
                       Pictures& pictures) {
    const auto& [since, change] = compared;
    ReportChange values{.since = day_of(*config.since_ms),
                        .change = change,
                        .colours = {},
                        .worse = {},
                        .better = {},
                        .map = {}};
    std::ranges::copy(ramp_colours(config.style.ramp, values.colours.size()),
                      values.colours.begin());
    if (change.segments.empty()) {
        return values;
    }
    auto scene = whole_map(store, verdicts());
    colour_change(scene, change.segments, since);
    values.map_width_m = pictures.map_width_m(scene);
    values.map = pictures.map(scene, &verdicts());
    values.worse = drawn(store, change.worse, change, since, pictures);
    values.better = drawn(store, change.better, change, since, pictures);
    return values;
}

} // namespace

Report report_of(const RoadStore& store, const ReportConfig& config, const Progress& progress) {
    const auto& classes = *config.style.classes;
    const auto info = store.info();
    const auto survey = survey_of(store);
    const auto roads = kept_roads(store);
    RoadStretchConfig poor;
    poor.above_mm_per_m = poor_above(classes);
    auto stretches = worst_stretches(roads, survey.measured, poor);

    Report report;
    report.wording = config.wording;
    report.title = config.title;
    report.period = days_of(info.first_seen_ms, info.last_seen_ms);
    report.network_source =
        info.settings.network_source == traced_source ? "" : info.settings.network_source;
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

    const auto change = compared(store, roads, config);
    stretches.resize(std::min(stretches.size(), config.worst));
    Pictures pictures{
        config, progress, stretches.size() + 1 + (change ? pictures_of(change->change) : 0)};
    const auto map = whole_map(store, classes);
    report.map = pictures.map(map);
    report.map_width_m = pictures.map_width_m(map);
    for (auto& stretch : stretches) {
        const auto scene = scene_of(store, stretch, survey.measured, classes);
        report.worst.push_back({.stretch = stretch,
                                .heading = std::string{heading_of(stretch)},
                                .seen = days_of(stretch.first_seen_ms, stretch.last_seen_ms),
                                .map = pictures.stretch(scene)});
    }
    if (change) {
        report.change = change_of(store, *change, config, pictures);
    }
    return report;
}

} // namespace macadam
