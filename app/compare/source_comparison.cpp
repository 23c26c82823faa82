#include "app/compare/source_comparison.hpp"

#include "app/database/car_names.hpp"

#include "app/compare/compared_database.hpp"
#include "app/compare/compared_profiles.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/surveys/reference_passes.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/surveys/reference_reader.hpp"
#include "storage/tables/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

namespace macadam {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Ends of a segment in two maps that differ by more do not bound the same road, metres.
constexpr double max_end_shift_m = 2;

std::string lower(std::string text) {
    std::ranges::transform(
        text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Tests whether the header names a place on the map.
bool has_places(const std::filesystem::path& file) {
    TextLines lines{file_bytes(file), file.string()};
    const auto header = lines.next().value_or("");
    return std::ranges::any_of(std::array{"lat_deg", "way_id"}, [&](std::string_view column) {
        return header.find(column) != std::string_view::npos;
    });
}

/// Names a source by its file, with the folder if the other source is another file of that name.
SourceName name_of(const SourceOption& source, const SourceOption& other, const std::string& car) {
    constexpr std::array kinds{"road database", "survey", "profile"};
    const bool is_clear =
        source.file == other.file || source.file.filename() != other.file.filename();
    return {(is_clear ? source.file.filename() : source.file).string(),
            kinds[static_cast<std::size_t>(source.kind)],
            car};
}

/// A source whose values belong to segments.
struct SegmentSource {
    std::optional<StoreReader> store; ///< of a database
    std::string car;                  ///< "car 1"; "" = all cars
    std::string pseudonym;            ///< of that car
    SourceSegments segments;
};

StoreReader opened_for_comparison(const std::filesystem::path& file, const Console& console) {
    auto store = opened_reader(file, console);
    warn_of_waiting(store, file, console);
    tell_publication(store, console);
    return store;
}

SegmentSource
database_source(const SourceOption& source, const SegmentFilter& filter, const Console& console) {
    SegmentSource opened{opened_for_comparison(source.file, console), {}, {}, {}};
    if (source.car) {
        opened.pseudonym = car_named(*opened.store, *source.car);
        opened.car =
            fmt::format("car {}", number_of_car(opened.store->usage().cars, opened.pseudonym));
        opened.segments = segments_by_car(*opened.store, filter, opened.pseudonym);
    } else {
        opened.segments = segments_by_cars(*opened.store, filter);
    }
    return opened;
}

/// Places a survey on the roads of a database.
SegmentSource
survey_source(const SourceOption& source, const CompareOptions& options, const StoreReader& roads) {
    const auto survey = read_reference(source.file, options.mm_per_m_of_one);
    const auto placed =
        reference_passes(survey, placed_on(load_or_build_network(roads), survey), {});
    if (placed.passes.empty()) {
        throw InputError{fmt::format("{}: none of its {} rows lies on the roads of {}",
                                     source.file.string(),
                                     survey.rows.size(),
                                     roads.file().string())};
    }
    std::map<SegmentKey, std::pair<double, double>> sums; // IRI, and number of passes
    for (const auto& pass : placed.passes) {
        auto& [iri, count] = sums[pass.segment];
        iri += static_cast<double>(pass.iri_um) / 1000;
        ++count;
    }
    SegmentSource opened;
    for (const auto& [key, sum] : sums) {
        opened.segments.emplace(key, SourceSegment{sum.first / sum.second, none, none, {}});
    }
    return opened;
}

/// Keeps the segments of a survey that meet the filter, and gives them their road class.
void keep_selected(SourceSegments& segments, SegmentFilter filter, const StoreReader& roads) {
    filter.with_state_only = false;
    filter.period.reset();
    std::set<SegmentKey> selected;
    roads.visit(filter, [&](const SegmentRecord& record) {
        if (const auto found = segments.find(record.segment.key); found != segments.end()) {
            found->second.highway = record.highway;
            found->second.from_m = record.segment.from_m;
            found->second.to_m = record.segment.to_m;
            selected.insert(record.segment.key);
        }
    });
    std::erase_if(segments, [&](const auto& segment) { return !selected.contains(segment.first); });
}

bool same_ends(const SourceSegment& a, const SourceSegment& b) {
    return std::isnan(a.from_m) || std::isnan(b.from_m) ||
           (std::abs(a.from_m - b.from_m) <= max_end_shift_m &&
            std::abs(a.to_m - b.to_m) <= max_end_shift_m);
}

/// Pairs of the segments that both sources know, with their road classes.
struct PairedSegments {
    std::vector<AgreementPair> pairs;
    std::vector<GroupName> road_classes;
    SharedSegments shared;
};

PairedSegments paired(const SourceSegments& a, const SourceSegments& b) {
    PairedSegments all;
    std::size_t known_to_both = 0;
    for (const auto& [key, ours] : a) {
        const auto found = b.find(key);
        if (found == b.end()) {
            continue;
        }
        ++known_to_both;
        const auto& theirs = found->second;
        if (!same_ends(ours, theirs)) {
            ++all.shared.cut_differently;
            continue;
        }
        const auto& ends = std::isnan(ours.from_m) ? theirs : ours;
        all.shared.km += (ends.to_m - ends.from_m) / 1000;
        all.pairs.push_back({key, ours.iri, theirs.iri});
        all.road_classes.push_back({0, ours.highway.empty() ? theirs.highway : ours.highway});
    }
    all.shared.only_a = a.size() - known_to_both;
    all.shared.only_b = b.size() - known_to_both;
    return all;
}

std::vector<GroupName> roughness_names(const std::vector<AgreementPair>& pairs,
                                       const ClassTable& classes) {
    std::vector<GroupName> names;
    for (const auto& pair : pairs) {
        const auto index = class_index(classes, (pair.a + pair.b) / 2);
        names.push_back({static_cast<int>(index), std::string{classes.classes[index].name}});
    }
    return names;
}

std::vector<GroupName> speed_names(const std::vector<std::optional<double>>& speed_kmh,
                                   bool in_mph) {
    constexpr double kmh_of_mph = 1.609344;
    constexpr std::array of_kmh{0, 30, 50, 70, 90, 110};
    constexpr std::array of_mph{0, 20, 30, 45, 55, 70};
    const auto& borders = in_mph ? of_mph : of_kmh;
    std::vector<GroupName> names;
    for (const auto& speed : speed_kmh) {
        if (!speed) {
            names.push_back({0, {}});
            continue;
        }
        const auto band = std::ranges::upper_bound(borders, in_mph ? *speed / kmh_of_mph : *speed) -
                          borders.begin() - 1;
        const auto from = borders[static_cast<std::size_t>(band)];
        names.push_back(
            {static_cast<int>(band),
             static_cast<std::size_t>(band) + 1 < borders.size()
                 ? fmt::format("{} – {}", from, borders[static_cast<std::size_t>(band) + 1])
                 : fmt::format("{} and more", from)});
    }
    return names;
}

/// Compares each car of A with B.
std::vector<AgreementGroup> agreement_by_car(const std::vector<AgreementPair>& pairs,
                                             const PassesOfCars& passes,
                                             const StoreReader& store) {
    const auto cars = store.usage().cars;
    std::vector<AgreementPair> of_cars;
    std::vector<GroupName> names;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        for (const auto& [car, iri] : passes.iri_by_car[i]) {
            of_cars.push_back({pairs[i].segment, iri, pairs[i].b});
            const auto number = number_of_car(cars, car);
            names.push_back({number, fmt::format("car {}", number)});
        }
    }
    return agreement_by_group(of_cars, names);
}

void add_groups(SourceComparison& comparison,
                std::string property,
                std::vector<AgreementGroup> groups) {
    if (!groups.empty()) {
        comparison.groups.push_back({std::move(property), std::move(groups)});
    }
}

bool is_own(const SegmentSource& source) {
    return source.store && source.store->settings().privacy == PrivacyProfile::own;
}

/// Adds speeds and cars from the compared passes of the first database that may show them.
void add_cars(SourceComparison& comparison,
              const SegmentSource& a,
              const SegmentSource& b,
              const CompareOptions& options) {
    const bool in_mph = options.speeds_in_mph;
    const auto* const source = is_own(a) ? &a : is_own(b) ? &b : nullptr;
    const auto passes = source == nullptr
                            ? std::nullopt
                            : passes_of_cars(*source->store,
                                             comparison.pairs,
                                             {options.filter.period, source->pseudonym});
    if (!passes) {
        return;
    }
    add_groups(comparison,
               in_mph ? "Speed, mph" : "Speed, km/h",
               agreement_by_group(comparison.pairs, speed_names(passes->speed_kmh, in_mph)));
    if (source == &a && a.car.empty()) {
        add_groups(comparison, "Car of A", agreement_by_car(comparison.pairs, *passes, *a.store));
    }
}

void expect_comparable(const SegmentSource& a, const SegmentSource& b) {
    if (a.store && b.store) {
        const double a_m = a.store->settings().segment_length_m;
        const double b_m = b.store->settings().segment_length_m;
        if (a_m != b_m) {
            throw InputError{fmt::format("{} has segments of {:g} m and {} of {:g} m, expected the "
                                         "same length; 'macadam init --segment-length' sets it",
                                         a.store->file().string(),
                                         a_m,
                                         b.store->file().string(),
                                         b_m)};
        }
    }
}

SourceComparison compare_segments(const CompareOptions& options, const Console& console) {
    const auto opened = [&](const SourceOption& source) {
        return source.kind == SourceKind::database
                   ? database_source(source, options.filter, console)
                   : SegmentSource{};
    };
    auto a = opened(options.a);
    auto b = opened(options.b);
    expect_comparable(a, b);
    std::optional<StoreReader> given_roads;
    if (!a.store && !b.store) {
        given_roads = opened_for_comparison(*options.roads, console);
    }
    const auto& roads = a.store ? *a.store : b.store ? *b.store : *given_roads;
    for (auto [side, source] : {std::pair{&a, &options.a}, std::pair{&b, &options.b}}) {
        if (source->kind == SourceKind::survey) {
            *side = survey_source(*source, options, roads);
            keep_selected(side->segments, options.filter, roads);
        }
    }
    auto pairs = paired(a.segments, b.segments);
    SourceComparison comparison{.a = name_of(options.a, options.b, a.car),
                                .b = name_of(options.b, options.a, b.car),
                                .pairs = std::move(pairs.pairs),
                                .all = {},
                                .shared = pairs.shared,
                                .groups = {},
                                .tracks = {}};
    comparison.is_own = is_own(a) || is_own(b);
    comparison.all = agreement_of(comparison.pairs);
    add_groups(comparison, "Road class", agreement_by_group(comparison.pairs, pairs.road_classes));
    add_groups(comparison,
               "Roughness",
               agreement_by_group(
                   comparison.pairs,
                   roughness_names(comparison.pairs, *class_table(roads.settings().class_table))));
    add_cars(comparison, a, b, options);
    return comparison;
}

} // namespace

SourceKind kind_of_source(const std::filesystem::path& file) {
    const auto name = lower(file.filename().string());
    if (name.ends_with(".gpkg")) {
        return SourceKind::database;
    }
    if (name.ends_with(".erd") || name.ends_with(".pro") || name.ends_with(".txt")) {
        return SourceKind::profile;
    }
    if (name.ends_with(".csv.gz") || name.ends_with(".csv.zst")) {
        return SourceKind::survey;
    }
    if (name.ends_with(".csv")) {
        return has_places(file) ? SourceKind::survey : SourceKind::profile;
    }
    throw InputError{
        fmt::format("{}: expected a road database (.gpkg), a survey (.csv) or a profile "
                    "(.csv, .txt, .erd, .pro)",
                    file.string())};
}

SourceComparison compare_sources(const CompareOptions& options, const Console& console) {
    const bool a_is_profile = options.a.kind == SourceKind::profile;
    const bool b_is_profile = options.b.kind == SourceKind::profile;
    if (a_is_profile && b_is_profile) {
        auto comparison =
            compare_profiles(options.a.file, options.b.file, options.step_m, options.profiles);
        comparison.a = name_of(options.a, options.b, {});
        comparison.b = name_of(options.b, options.a, {});
        return comparison;
    }
    if (a_is_profile || b_is_profile) {
        const auto& profile = a_is_profile ? options.a : options.b;
        throw InputError{
            fmt::format("{}: a profile has no place on a road and is compared with "
                        "another profile; for a database, make a survey of it: 'macadam "
                        "iri --length 20' and a place for each row",
                        profile.file.string())};
    }
    return compare_segments(options, console);
}

} // namespace macadam
