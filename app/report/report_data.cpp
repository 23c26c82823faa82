#include "app/report/report_data.hpp"

#include "app/database/selection.hpp"
#include "app/query/section_query.hpp"
#include "app/query/worst_sections_output.hpp"
#include "app/render/change_map.hpp"
#include "app/report/report_survey.hpp"
#include "app/report/strip_pieces.hpp"
#include "mapping/analysis/worst_sections.hpp"

#include "render/scene/colour.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/text/utc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>
#include <utility>

namespace macadam {
namespace {

/// Axis of the histogram: round numbers of the unit.
struct HistogramAxis {
    double step, min_end, max_end; ///< in the unit
    double round_to;               ///< of the end
    double mm_per_m_of_one;
};
constexpr HistogramAxis metric_axis{0.25, 4, 12, 1, 1};
constexpr HistogramAxis us_axis{10, 250, 750, 50, 1 / in_per_mi_of_mm_per_m};

const HistogramAxis& axis_in(IriUnit unit) {
    return unit == IriUnit::mm_per_m ? metric_axis : us_axis;
}

constexpr std::size_t max_changed = 10; // sections of each kind

std::string day_of(std::int64_t utc_ms) {
    return utc_day(utc_ms);
}

ReportDays days_of(std::optional<std::int64_t> first_ms, std::optional<std::int64_t> last_ms) {
    return first_ms && last_ms ? ReportDays{day_of(*first_ms), day_of(*last_ms)} : ReportDays{};
}

/// Returns the first and last day on which measured segments were seen.
ReportDays days_of(const std::vector<MeasuredSegment>& measured) {
    std::optional<std::int64_t> first_ms, last_ms;
    for (const auto& segment : measured) {
        if (segment.first_seen_ms) {
            first_ms = std::min(first_ms.value_or(*segment.first_seen_ms), *segment.first_seen_ms);
        }
        if (segment.last_seen_ms) {
            last_ms = std::max(last_ms.value_or(*segment.last_seen_ms), *segment.last_seen_ms);
        }
    }
    return days_of(first_ms, last_ms);
}

/// Returns the number of bins for all but the roughest percent.
std::size_t histogram_bins(const std::vector<MeasuredSegment>& measured,
                           const HistogramAxis& axis) {
    std::vector<RatedLength> pieces;
    pieces.reserve(measured.size());
    for (const auto& segment : measured) {
        pieces.push_back(rated_length(segment));
    }
    const double most = pieces.empty() ? 0 : road_percentile(std::move(pieces), 0.99);
    const double end = axis.round_to * std::ceil(most / axis.mm_per_m_of_one / axis.round_to);
    return static_cast<std::size_t>(
        std::lround(std::clamp(end, axis.min_end, axis.max_end) / axis.step));
}

// --------------------------------------------------------------------------------------- values

/// Returns the numbers of cars from 1 on, as in StoreUsage::cars; "" for trips that name none.
std::map<std::string, std::string> numbers_of_cars(const StoreUsage& usage) {
    std::map<std::string, std::string> numbers;
    for (const auto& car : usage.cars) {
        numbers[car] = car == unknown_car ? "" : std::to_string(numbers.size() + 1);
    }
    return numbers;
}

std::vector<ReportVehicle> vehicles_of(const StoreUsage& usage) {
    auto numbers = numbers_of_cars(usage);
    std::vector<ReportVehicle> vehicles;
    for (const auto& use : usage.vehicles) {
        vehicles.push_back({.name = numbers[use.vehicle],
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

std::vector<ReportSection>
sections_of(const StoreReader& store, const SectionOptions& options, const SegmentFilter& filter) {
    std::vector<ReportSection> sections;
    each_section(store, options, filter, [&](const NamedSection& named) {
        sections.push_back({.name = named.name,
                            .from_m = named.from_m,
                            .to_m = named.to_m,
                            .excluded_m = named.section.excluded_m,
                            .open_share = named.section.open_share,
                            .measured = named.section.measured});
    });
    return sections;
}

std::optional<ReportPublication> publication_of(const StoreInfo& info) {
    if (!info.published_alone) {
        return std::nullopt;
    }
    ReportPublication crowd;
    if (const auto& publication = info.publication) {
        crowd = {.month = publication->month,
                 .trips = info.trips,
                 .cars = static_cast<std::size_t>(publication->vehicles),
                 .passes = info.passes,
                 .left_out = publication->left_out,
                 .left_out_m = 1000 * publication->left_out_km};
    }
    return crowd;
}

// --------------------------------------------------------------------------------------- change

constexpr int middle_rank = 3; // line width for town streets and main roads

/// Draws compared segments over a scene with muted roads.
void colour_change(const StoreReader& store,
                   const std::vector<SegmentVerdict>& segments,
                   MapScene& scene) {
    SegmentFilter compared;
    compared.with_state_only = false;
    compared.ranges.emplace();
    std::map<std::pair<std::int64_t, std::uint32_t>, int> directions;
    for (const auto& [key, verdict] : segments) {
        compared.ranges->push_back({key.way_id, key.forward, key.index, key.index + 1});
        ++directions[{key.way_id, key.index}];
    }
    auto next = segments.begin();
    store.visit(compared, [&](const SegmentRecord& record) {
        const auto& [key, verdict] = *next++;
        MapLine line;
        line.line = record.segment.line;
        line.iri_class = static_cast<int>(verdict.value_or(Verdict::no_change_shown));
        line.forward = key.forward;
        line.both_ways = directions.at({key.way_id, key.index}) == 2;
        line.rank = middle_rank;
        scene.lines.push_back(std::move(line));
    });
}

std::vector<ReportChangedStretch> drawn(const StoreReader& store,
                                        const std::vector<ChangedStretch>& stretches,
                                        const ComparedStates& compared,
                                        ReportPictures& pictures) {
    std::vector<ReportChangedStretch> listed;
    for (const auto& stretch : stretches | std::views::take(max_changed)) {
        std::vector<SegmentVerdict> segments;
        for (const auto i : stretch.stretch.records) {
            segments.push_back({compared.keys[i], compared.change.segments[i].verdict});
        }
        auto scene = quiet_scene(store, stretch.stretch, change_classes());
        colour_change(store, segments, scene);
        listed.push_back({stretch,
                          std::string{heading_of(stretch.stretch)},
                          pictures.stretch(std::move(scene), true)});
    }
    return listed;
}

std::size_t pictures_of(const ChangeSince& change) {
    return 1 + std::min(change.worse.size(), max_changed) +
           std::min(change.better.size(), max_changed);
}

ReportChange change_of(const StoreReader& store,
                       ComparedStates compared,
                       const ReportConfig& config,
                       ReportPictures& pictures) {
    ReportChange values{.since = day_of(*config.since_ms),
                        .change = {},
                        .colours = {},
                        .dark_colours = {},
                        .worse = {},
                        .better = {},
                        .map = {}};
    std::ranges::copy(change_colours(false), values.colours.begin());
    std::ranges::copy(change_colours(true), values.dark_colours.begin());
    if (!compared.change.segments.empty()) {
        pictures.expect_more(pictures_of(compared.change));
        auto map = whole_scene(store,
                               config.style,
                               config.pictures,
                               config.filter,
                               [&](const GeoBox& box, double scale) {
                                   auto lines = change_lines(store, box, compared.verdicts, scale);
                                   for (auto& line : lines) { // not comparable: as unmeasured
                                       line.iri_class = line.few_passes ? -1 : line.iri_class;
                                       line.few_passes = false;
                                   }
                                   return lines;
                               });
        values.map_width_m = pictures.map_width_m(map.scene);
        values.map = pictures.map(std::move(map), true);
        values.worse = drawn(store, compared.change.worse, compared, pictures);
        values.better = drawn(store, compared.change.better, compared, pictures);
    }
    values.change = std::move(compared.change);
    return values;
}

/// Describes the roads that the maps draw in grey, if any.
std::optional<ReportFewPasses> few_passes_of(const MapScene& map, const ReportConfig& config) {
    const auto is_grey = [](const MapLine& line) { return line.iri_class >= 0 && line.few_passes; };
    if (std::ranges::none_of(map.lines, is_grey)) {
        return std::nullopt;
    }
    using enum MapStyle::Theme;
    const auto grey = [&](MapStyle::Theme theme) {
        return palette(in_theme(config.style, theme)).few_passes;
    };
    const bool on_paper = config.pictures == PictureUse::paper;
    return ReportFewPasses{config.style.min_passes, grey(on_paper ? print : light), grey(dark)};
}

/// Takes the largest events of the database into the report.
void put_events(const StoreReader& store, const SegmentFilter& filter, Report& report) {
    constexpr std::size_t max_events = 100;
    auto records = store.events(filter);
    std::ranges::stable_sort(
        records, std::ranges::greater{}, [](const auto& record) { return record.event.size_um; });
    report.events_found = records.size();
    records.resize(std::min(records.size(), max_events));
    for (const auto& [event, at, name, highway] : records) {
        report.events.push_back(
            {.kind = event.kind,
             .size_mm = event.size_um / 1000.0,
             .sd_mm = event.sd_um / 1000.0,
             .name = name,
             .highway = highway,
             .way_id = event.segment.way_id,
             .at_m = static_cast<double>(event.at_mm) / 1000,
             .at = at,
             .passes = event.passes,
             .passes_over = event.passes_over,
             .last_seen = event.last_seen_ms ? utc_day(*event.last_seen_ms) : std::string{}});
    }
}

/// Puts in what the measured segments amount to.
void put_summary(const Survey& survey, const ReportConfig& config, Report& report) {
    const auto& classes = *config.style.classes;
    report.summary = network_summary(survey.measured, survey.network_m, classes);
    const auto& axis = axis_in(config.wording.unit);
    report.histogram = iri_histogram(survey.measured,
                                     classes,
                                     axis.step * axis.mm_per_m_of_one,
                                     histogram_bins(survey.measured, axis));
    report.segments = survey.segments;
    report.segments_with_passes = survey.measured.size();
    report.quality = data_quality(survey.measured);
}

/// Finds the sections of poor road, counts them in the report, and returns those to list.
std::vector<WorstSection> sections_to_list(const RoadNetwork& roads,
                                           const Survey& survey,
                                           const ReportConfig& config,
                                           Report& report) {
    WorstSectionConfig poor;
    poor.above_mm_per_m = poor_above(*config.style.classes);
    auto stretches = worst_sections(roads, survey.measured, poor);
    sort_by_need(stretches, poor.above_mm_per_m);
    report.poor_above_mm_per_m = poor.above_mm_per_m;
    report.min_stretch_m = poor.min_length_m;
    report.stretches = stretches.size();
    for (const auto& stretch : stretches) {
        report.stretches_m += stretch.length_m;
    }
    stretches.resize(std::min(stretches.size(), config.worst));
    return stretches;
}

void put_worst(const StoreReader& store,
               const std::vector<WorstSection>& stretches,
               const Survey& survey,
               const ClassTable& classes,
               ReportPictures& pictures,
               Report& report) {
    for (const auto& stretch : stretches) {
        report.worst.push_back(
            {.stretch = stretch,
             .heading = std::string{heading_of(stretch)},
             .seen = days_of(stretch.first_seen_ms, stretch.last_seen_ms),
             .map = pictures.stretch(stretch_scene(store, stretch, survey.measured, classes)),
             .strip = strip_of(stretch, survey.measured, classes)});
    }
}

void put_overview(const StoreReader& store,
                  const ReportConfig& config,
                  ReportPictures& pictures,
                  Report& report) {
    auto map = whole_scene(store, config.style, config.pictures, config.filter);
    report.few_passes = few_passes_of(map.scene, config);
    report.map_width_m = pictures.map_width_m(map.scene);
    report.map = pictures.map(std::move(map));
}

} // namespace

Report report_of(const StoreReader& store, const ReportConfig& config, const Progress& progress) {
    const auto& classes = *config.style.classes;
    const auto info = store.info();
    auto survey = survey_of(store, config.filter);
    auto roads = load_or_build_network(store);

    Report report;
    report.wording = config.wording;
    report.title = config.title;
    report.period = selects(config.filter) ? days_of(survey.measured)
                                           : days_of(info.first_seen_ms, info.last_seen_ms);
    report.selection = config.selection;
    report.network_source =
        info.settings.network_source == traced_network_source ? "" : info.settings.network_source;
    report.attribution = info.settings.attribution;
    report.segment_length_m = info.settings.segment_length_m;
    report.classes = &classes;
    report.colours = class_colours(config.style, classes.classes.size());
    report.words = config.style.words;
    put_summary(survey, config, report);
    const auto stretches = sections_to_list(roads, survey, config, report);
    if (config.sections) {
        report.sections = sections_of(store, *config.sections, config.filter);
    }
    if (config.strip) {
        report.strips =
            route_strips(store, roads, *config.strip, config.filter, classes, config.wording);
    }
    const auto usage = store.usage();
    report.vehicles = vehicles_of(usage);
    report.publication = publication_of(info);
    report.is_own = info.settings.privacy == PrivacyProfile::own;
    report.lateral_passes = info.lateral_passes;
    report.row_reasons = usage.row_reasons;

    if (config.events) {
        put_events(store, config.filter, report);
    }

    ReportPictures pictures{config.style, config.pictures, progress, stretches.size() + 1};
    put_worst(store, stretches, survey, classes, pictures, report);
    survey = {}; // both make room for the roads of the map
    roads = {};
    put_overview(store, config, pictures, report);
    if (config.since_ms) {
        auto compared = compare_since(store, config.filter, *config.since_ms);
        report.change = change_of(store, std::move(compared), config, pictures);
    }
    return report;
}

} // namespace macadam
