#include "app/export/tile_line_merging.hpp"

#include "app/render/map_scene.hpp"
#include "render/roads/line_widths.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr double line_px = 8;
constexpr double value_px = 2;
// An edge is cut into equal segments: one of 29 m has a single segment of 29 m.
constexpr double longest_segment = 1.5;

double metres_per_px(const WorldScale& scale) {
    constexpr double equator_m = 2 * std::numbers::pi * 6378137.0; // WGS 84
    return equator_m / (scale.tile_px * std::exp2(scale.zoom));
}

std::uint32_t power_of_two_within(double length_m, double segment_length_m) {
    const double count = std::clamp(length_m / segment_length_m, 1.0, 1e6);
    return std::bit_floor(std::uint32_t(count));
}

/// Segment data that a line needs.
struct Bit {
    std::uint32_t index;
    IriUm iri_um; ///< negative: not measured
    bool certain;
    bool few_passes;
    std::vector<GeoPoint> line;
};

/// Value that a line shows.
struct Value {
    double iri_um = -1;
    bool certain = true;
    bool few_passes = false;
};

/// Orders a class before the grey of few passes, that before no measurement, and the worse of two
/// classes first.
bool is_worse(const Value& a, const Value& b) {
    return std::pair{a.iri_um >= 0 && !a.few_passes, a.iri_um} >
           std::pair{b.iri_um >= 0 && !b.few_passes, b.iri_um};
}

/// Merges the segments of one way into lines.
class WayLines {
public:
    WayLines(const TileLineRules& rules, const ClassTable& classes, int min_passes)
        : rules_{rules}, classes_{classes}, min_passes_{min_passes} {}

    void add(const SegmentSummary& segment) {
        const auto& key = segment.key;
        if (key.way_id != way_id_) {
            finish();
            way_id_ = key.way_id;
            rank_ = rank_of(segment.highway);
            name_ = segment.name;
        }
        const auto& roughness = segment.roughness;
        bits_[key.forward ? 0 : 1].push_back(
            {key.index,
             roughness ? roughness->iri_um : -1,
             roughness && is_certain(roughness->iri_um, roughness->sd_um),
             roughness && has_few_passes(roughness->passes, min_passes_),
             {segment.line.begin(), segment.line.end()}});
    }

    std::vector<MapLine> lines() && {
        finish();
        return std::move(lines_);
    }

private:
    using Bits = std::vector<Bit>;

    void finish() {
        auto& [forward, backward] = bits_;
        const bool both = !forward.empty() && !backward.empty();
        if (rules_.separate_ways) {
            add_lines(forward, values_of(forward), true, backward);
            add_lines(backward, values_of(backward), false, forward);
        } else if (!both) {
            auto& only = forward.empty() ? backward : forward;
            add_lines(only, values_of(only), !forward.empty(), {});
        } else {
            add_merged();
        }
        forward.clear();
        backward.clear();
    }

    /// Returns a value for each segment; segments that share a value have the same.
    std::vector<Value> values_of(const Bits& bits) const {
        std::vector<Value> values;
        for (std::size_t first = 0; first < bits.size();) {
            auto past = first;
            double sum_um = 0;
            std::size_t measured = 0;
            std::size_t certain = 0;
            std::size_t few_passes = 0;
            for (; past < bits.size() &&
                   bits[past].index / rules_.per_value == bits[first].index / rules_.per_value;
                 ++past) {
                if (bits[past].iri_um >= 0) {
                    sum_um += bits[past].iri_um;
                    ++measured;
                    certain += bits[past].certain ? 1 : 0;
                    few_passes += bits[past].few_passes ? 1 : 0;
                }
            }
            Value value;
            if (measured > 0 && 2 * measured >= past - first) {
                value = {
                    sum_um / double(measured), 2 * certain >= measured, 2 * few_passes > measured};
            }
            values.resize(past, value);
            first = past;
        }
        return values;
    }

    /// Adds one line for both directions, along the way, with the worse value.
    void add_merged() {
        auto& [forward, backward] = bits_;
        auto values = values_of(forward);
        const auto others = values_of(backward);
        Bits alone;
        for (std::size_t i = 0, k = 0; k < backward.size(); ++k) {
            while (i < forward.size() && forward[i].index < backward[k].index) {
                ++i;
            }
            if (i == forward.size() || forward[i].index != backward[k].index) {
                alone.push_back(std::move(backward[k]));
            } else if (is_worse(others[k], values[i])) {
                values[i] = others[k];
            }
        }
        add_lines(forward, values, true, {});
        add_lines(alone, values_of(alone), false, {});
    }

    /// Adds the lines of one direction.
    /// \param bits    source of the lines, which are moved
    /// \param others  segments of the other direction, if they have lines of their own
    void add_lines(Bits& bits, const std::vector<Value>& values, bool forward, const Bits& others) {
        std::optional<Look> last;
        for (std::size_t i = 0, k = 0; i < bits.size(); ++i) {
            while (k < others.size() && others[k].index < bits[i].index) {
                ++k;
            }
            const Look look{
                bits[i].index / rules_.per_line,
                values[i].iri_um < 0 ? -1 : int(class_index(classes_, values[i].iri_um / 1000)),
                values[i].certain,
                values[i].few_passes,
                k < others.size() && others[k].index == bits[i].index};
            if (last != look || !goes_on(bits[i].line, forward)) {
                lines_.push_back({.line = std::move(bits[i].line),
                                  .iri_class = look.iri_class,
                                  .both_ways = look.both_ways,
                                  .forward = forward,
                                  .rank = rank_,
                                  .certain = look.certain,
                                  .few_passes = look.few_passes,
                                  .name = name_});
            }
            last = look;
        }
    }

    struct Look {
        std::uint32_t block;
        int iri_class;
        bool certain;
        bool few_passes;
        bool both_ways;
        friend bool operator==(const Look&, const Look&) = default;
    };

    /// Extends the last line if the next segment meets it. Segments are numbered along the way, so
    /// against it the next segment comes before the last.
    bool goes_on(const std::vector<GeoPoint>& line, bool forward) {
        auto& last = lines_.back().line;
        if (forward && last.back() == line.front()) {
            last.insert(last.end(), line.begin() + 1, line.end());
            return true;
        }
        if (!forward && line.back() == last.front()) {
            last.insert(last.begin(), line.begin(), line.end() - 1);
            return true;
        }
        return false;
    }

    const TileLineRules& rules_;
    const ClassTable& classes_;
    int min_passes_;
    std::int64_t way_id_ = 0;
    int rank_ = 0;
    std::string name_;
    std::array<Bits, 2> bits_; ///< along the way and against it, by segment number
    std::vector<MapLine> lines_;
};

} // namespace

TileLineRules tile_line_rules(const WorldScale& scale, double segment_length_m, double reach_px) {
    const double px_m = metres_per_px(scale);
    const auto per_line = power_of_two_within(line_px * px_m, segment_length_m);
    const double longest_m = longest_segment * segment_length_m * per_line;
    return {.per_line = per_line,
            .per_value = power_of_two_within(value_px * px_m, segment_length_m),
            .separate_ways = tile_widths(zoom_of_256_px(scale)).separate_ways,
            // A line on the tile and, if lines consist of several segments, the whole next line.
            .margin_m = (per_line > 1 ? 2 : 1) * longest_m + reach_px * px_m};
}

std::vector<MapLine> tile_lines(const StoreReader& store,
                                const GeoBox& box,
                                const TileLineRules& rules,
                                const ClassTable& classes,
                                int min_passes) {
    SegmentFilter filter;
    filter.box = grown(box, rules.margin_m);
    filter.with_state_only = false;
    WayLines ways{rules, classes, min_passes};
    store.visit_summaries(filter, [&](const SegmentSummary& segment) { ways.add(segment); });
    return std::move(ways).lines();
}

} // namespace macadam
