#include "render/tiles/mvt_tile.hpp"

#include "estimator/roughness/roughness_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace macadam {
namespace {

namespace chr = std::chrono;

// ------------------------------------------------------------------------------------- segments

enum SegmentField : std::uint32_t {
    segment_field,
    way_id,
    name,
    highway,
    direction,
    from_m,
    to_m,
    iri,
    iri_class,
    passes,
    last_seen,
    is_valid,
    iri_sd,
    iri_low,
    iri_high,
    vehicles,
    first_seen,
    trend_per_year
};
constexpr std::array<std::string_view, 18> segment_keys{"segment",
                                                        "way_id",
                                                        "name",
                                                        "highway",
                                                        "direction",
                                                        "from_m",
                                                        "to_m",
                                                        "iri",
                                                        "class",
                                                        "passes",
                                                        "last_seen",
                                                        "validity",
                                                        "iri_sd",
                                                        "iri_low",
                                                        "iri_high",
                                                        "vehicles",
                                                        "first_seen",
                                                        "trend_per_year"};

/// The same in units of the United States.
constexpr std::array<std::string_view, 18> us_segment_keys{"segment",
                                                           "way_id",
                                                           "name",
                                                           "highway",
                                                           "direction",
                                                           "from_ft",
                                                           "to_ft",
                                                           "iri_in_per_mi",
                                                           "class",
                                                           "passes",
                                                           "last_seen",
                                                           "validity",
                                                           "iri_sd_in_per_mi",
                                                           "iri_low_in_per_mi",
                                                           "iri_high_in_per_mi",
                                                           "vehicles",
                                                           "first_seen",
                                                           "trend_per_year_in_per_mi"};

constexpr bool is_text(std::uint32_t field) {
    return field == segment_field || field == name || field == highway || field == direction ||
           field == iri_class || field == last_seen || field == is_valid || field == first_seen;
}

/// Rounds to 0.01 mm/m or 1 in/mi, which makes many values equal: a tenth of their uncertainty.
double rounded_iri(double mm_per_m, TileUnits units) {
    return units == TileUnits::us
               ? static_cast<double>(std::llround(mm_per_m * in_per_mi_of_mm_per_m))
               : static_cast<double>(std::llround(mm_per_m * 100)) / 100;
}

constexpr double ft_of_m = 1 / 0.3048; // international foot

/// Rounds to 0.1 m or 0.1 ft.
double rounded_length(double m, TileUnits units) {
    const double length = units == TileUnits::us ? m * ft_of_m : m;
    return static_cast<double>(std::llround(length * 10)) / 10;
}

void put_digits(std::array<char, 10>& text, std::size_t at, unsigned value, std::size_t digits) {
    for (; digits > 0; --digits, value /= 10) {
        text[at + digits - 1] = static_cast<char>('0' + value % 10);
    }
}

/// "2026-03-01"
std::array<char, 10> text_of(const chr::year_month_day& day) {
    std::array text{'0', '0', '0', '0', '-', '0', '0', '-', '0', '0'};
    put_digits(text, 0, static_cast<unsigned>(int{day.year()}), 4);
    put_digits(text, 5, unsigned{day.month()}, 2);
    put_digits(text, 8, unsigned{day.day()}, 2);
    return text;
}

/// Property with a day, cached because most neighbours have the same.
class DayField {
public:
    explicit DayField(std::uint32_t key) : key_{key} {}

    void add_to(VectorLayer& layer, const std::optional<std::int64_t>& utc_ms) {
        if (!utc_ms) {
            return;
        }
        const auto day =
            chr::floor<chr::days>(chr::sys_time<chr::milliseconds>{chr::milliseconds{*utc_ms}});
        if (day != day_) {
            day_ = day;
            text_ = text_of(day);
        }
        layer.add(key_, std::string_view{text_.data(), text_.size()});
    }

private:
    std::uint32_t key_;
    std::optional<chr::sys_days> day_;
    std::array<char, 10> text_{};
};

void add_word(VectorLayer& layer, std::uint32_t key, std::string_view word) {
    if (!word.empty()) {
        layer.add(key, word);
    }
}

void add_place(VectorLayer& layer, const TileSegment& segment, const VectorTileContext& context) {
    const auto& key = segment.state.segment;
    layer.add_unlike(segment_field, name_of(key));
    layer.add(way_id, key.way_id);
    add_word(layer, name, context.words->word(segment.name));
    add_word(layer, highway, context.words->word(segment.highway));
    layer.add(direction, key.forward ? "forward" : "backward");
    layer.add_real(from_m, rounded_length(segment.from_m, context.units));
    layer.add_real(to_m, rounded_length(segment.to_m, context.units));
}

void add_roughness(VectorLayer& layer,
                   const SegmentState& state,
                   const VectorTileContext& context,
                   DayField& last_seen_day) {
    const double mm_per_m = state.iri_um / 1000.0;
    const auto& classes = *context.classes;
    layer.add_real(iri, rounded_iri(mm_per_m, context.units));
    layer.add(iri_class, classes.classes[class_index(classes, mm_per_m)].name);
    layer.add(passes, std::int64_t{state.passes});
    last_seen_day.add_to(layer, state.last_seen_ms);
    if (state.validity == validity::ok) {
        layer.add(is_valid, "ok");
    } else {
        layer.add(is_valid, name_of_validity(state.validity));
    }
}

void add_detail(VectorLayer& layer,
                const SegmentState& state,
                TileUnits units,
                DayField& first_seen_day) {
    layer.add_real(iri_sd, rounded_iri(state.sd_um / 1000.0, units));
    layer.add_real(iri_low, rounded_iri(state.low_um / 1000.0, units));
    layer.add_real(iri_high, rounded_iri(state.high_um / 1000.0, units));
    layer.add(vehicles, std::int64_t{state.vehicles});
    first_seen_day.add_to(layer, state.first_seen_ms);
    if (state.trend_um_per_year) {
        layer.add_real(trend_per_year, rounded_iri(*state.trend_um_per_year / 1000.0, units));
    }
}

// ---------------------------------------------------------------------------------------- parts

enum PartField : std::uint32_t {
    part_name,
    part_highway,
    part_iri,
    part_class,
    part_passes,
    part_last_seen,
    part_validity,
    part_worst,
    part_length,
    part_of_class ///< first of one per class
};
constexpr std::array<std::string_view, part_of_class> part_keys{
    "name", "highway", "iri", "class", "passes", "last_seen", "validity", "iri_worst", "length_m"};
constexpr std::array<std::string_view, part_of_class> us_part_keys{"name",
                                                                   "highway",
                                                                   "iri_in_per_mi",
                                                                   "class",
                                                                   "passes",
                                                                   "last_seen",
                                                                   "validity",
                                                                   "iri_worst_in_per_mi",
                                                                   "length_ft"};

/// "very good" -> "very_good_m"
std::string length_key(const IriClass& roughness, TileUnits units) {
    auto key = fmt::format("{}_{}", roughness.name, units == TileUnits::us ? "ft" : "m");
    std::ranges::replace(key, ' ', '_');
    return key;
}

std::vector<std::string> length_keys(const ClassTable& classes, TileUnits units) {
    std::vector<std::string> keys;
    for (const auto& roughness : classes.classes) {
        keys.push_back(length_key(roughness, units));
    }
    return keys;
}

std::int64_t whole_length(std::int64_t mm, TileUnits units) {
    return units == TileUnits::us ? std::llround(static_cast<double>(mm) / 1000 * ft_of_m)
                                  : (mm + 500) / 1000;
}

void add_lengths(VectorLayer& layer, const RoadPart& part, TileUnits units) {
    layer.add(part_length, whole_length(length_mm(part), units));
    const auto classes = std::ranges::count_if(part.class_mm, [](auto mm) { return mm > 0; });
    for (std::uint32_t i = 0; classes > 1 && i < part.class_mm.size(); ++i) {
        if (part.class_mm[i] > 0) {
            layer.add(part_of_class + i, whole_length(part.class_mm[i], units));
        }
    }
}

void add_part(VectorLayer& layer,
              const RoadPart& part,
              const VectorTileContext& context,
              DayField& last_seen_day) {
    if (part.is_directed) { // from zoom 12 on: below, names do not fit
        add_word(layer, part_name, context.words->word(part.name));
        last_seen_day.add_to(layer, part.last_seen_ms);
    }
    add_word(layer, part_highway, context.words->word(part.highway));
    layer.add_real(part_iri, rounded_iri(iri_of(part), context.units));
    layer.add(part_class, context.classes->classes[class_of(part, *context.classes)].name);
    layer.add(part_passes, std::int64_t{part.passes});
    if (part.validity != validity::ok) {
        layer.add(part_validity, name_of_validity(part.validity));
    }
    layer.add_real(part_worst, rounded_iri(part.worst_um / 1000.0, context.units));
    add_lengths(layer, part, context.units);
    layer.end(feature_id(part.first));
}

const auto& segment_keys_in(TileUnits units) {
    return units == TileUnits::us ? us_segment_keys : segment_keys;
}

const auto& part_keys_in(TileUnits units) {
    return units == TileUnits::us ? us_part_keys : part_keys;
}

} // namespace

std::vector<VectorField> vector_fields(const ClassTable& classes, TileUnits units) {
    std::vector<VectorField> fields;
    const auto& of_segments = segment_keys_in(units);
    for (std::uint32_t i = 0; i < of_segments.size(); ++i) {
        fields.push_back({std::string{of_segments[i]}, !is_text(i)});
    }
    for (const auto of_part : {part_worst, part_length}) {
        fields.push_back({std::string{part_keys_in(units)[of_part]}, true});
    }
    for (const auto& key : length_keys(classes, units)) {
        fields.push_back({key, true});
    }
    return fields;
}

std::optional<std::uint64_t> feature_id(const SegmentKey& key) {
    constexpr int index_bits = 18,
                  way_bits = 34; // plus one for the direction: 53, the precision of doubles
    const bool fits = key.way_id >= 0 && key.way_id < std::int64_t{1} << way_bits &&
                      key.index < std::uint32_t{1} << index_bits;
    if (!fits) {
        return std::nullopt;
    }
    return (static_cast<std::uint64_t>(key.way_id) << (index_bits + 1)) |
           (std::uint64_t{key.index} << 1U) | (key.forward ? 0U : 1U);
}

std::string vector_tile(const TileId& tile,
                        std::span<const TileSegment* const> segments,
                        SegmentDetail detail,
                        const VectorTileContext& context) {
    VectorLayer layer{roughness_layer, tile, segment_keys_in(context.units)};
    DayField first_seen_day{first_seen}, last_seen_day{last_seen};
    for (const auto* const segment : segments) {
        if (!layer.begin(segment->line)) {
            continue;
        }
        add_place(layer, *segment, context);
        add_roughness(layer, segment->state, context, last_seen_day);
        if (detail == SegmentDetail::full) {
            add_detail(layer, segment->state, context.units, first_seen_day);
        }
        layer.end(feature_id(segment->state.segment));
    }
    return layer.count() > 0 ? layer.tile_bytes() : std::string{};
}

std::string vector_tile(const TileId& tile,
                        std::span<const RoadPart* const> parts,
                        const VectorTileContext& context) {
    const auto of_classes = length_keys(*context.classes, context.units);
    const auto& own_keys = part_keys_in(context.units);
    std::vector<std::string_view> keys{own_keys.begin(), own_keys.end()};
    keys.insert(keys.end(), of_classes.begin(), of_classes.end());
    VectorLayer layer{roughness_layer, tile, keys};
    DayField last_seen_day{part_last_seen};
    for (const auto* const part : parts) {
        if (layer.begin(part->line)) {
            add_part(layer, *part, context, last_seen_day);
        }
    }
    return layer.count() > 0 ? layer.tile_bytes() : std::string{};
}

} // namespace macadam
