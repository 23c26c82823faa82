#include "app/report/route_strips.hpp"

#include "app/report/strip_pieces.hpp"
#include "estimator/common/error.hpp"
#include "mapping/routes/linear_route.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace macadam {
namespace {

constexpr double max_strip_m = 2000; // 100 segments, which a page's width shows apart
constexpr std::size_t max_strips = 30;

using Records = std::map<SegmentKey, SegmentRecord>;

SegmentKey opposite(SegmentKey key) {
    key.forward = !key.forward;
    return key;
}

Records records_of(const StoreReader& store,
                   const std::vector<RouteSegment>& pieces,
                   const SegmentFilter& filter) {
    auto both = pieces;
    for (const auto& piece : pieces) {
        both.push_back(piece);
        if (piece.segment) {
            both.back().segment = opposite(*piece.segment);
        }
    }
    SegmentFilter on_road;
    on_road.ranges = ranges_of(both);
    on_road.period = filter.period;
    on_road.min_passes = filter.min_passes;
    on_road.min_vehicles = filter.min_vehicles;
    on_road.vehicle = filter.vehicle;
    Records records;
    store.visit(on_road, [&](const SegmentRecord& record) {
        if (record.state) {
            records.emplace(record.segment.key, record);
        }
    });
    return records;
}

/// Returns the names of the roads that meet the end of an edge, but for its own: "A; B".
std::string names_at_end(const RoadNetwork& roads, EdgeId edge) {
    std::set<std::string> names;
    const auto own = way_of(roads, edge).name;
    for (const auto other : out_edges(roads, to_node(roads, edge))) {
        const auto name = way_of(roads, other).name;
        if (!name.empty() && name != own) {
            names.emplace(name);
        }
    }
    std::string text;
    for (const auto& name : names) {
        text += (text.empty() ? "" : "; ") + name;
    }
    return text;
}

std::vector<StripMark> junctions_of(const RoadNetwork& roads, const LinearRoute& road) {
    constexpr double at_end_m = 0.01; // an interval that ends here ends with its edge
    std::vector<StripMark> marks;
    double at_m = 0;
    for (const auto& [edge, from_m, to_m] : road.parts) {
        at_m += to_m - from_m;
        if (edge && to_m >= length_m(roads, *edge) - at_end_m) {
            if (auto names = names_at_end(roads, *edge); !names.empty()) {
                marks.push_back({at_m, std::move(names)});
            }
        }
    }
    return marks;
}

/// Returns where the road runs along an interval of a way, in chainage; parts that touch are
/// joined.
std::vector<StripSpan> spans_of(const std::vector<RouteSegment>& pieces,
                                std::int64_t way_id,
                                double from_m,
                                double to_m,
                                const std::string& name) {
    constexpr double touching_m = 0.1;
    std::vector<StripSpan> spans;
    for (const auto& piece : pieces) {
        if (!piece.segment || piece.segment->way_id != way_id || piece.way_to_m <= from_m ||
            to_m <= piece.way_from_m) {
            continue;
        }
        const double low = std::max(from_m, piece.way_from_m) - piece.way_from_m;
        const double high = piece.way_to_m - std::min(to_m, piece.way_to_m);
        const bool along = piece.segment->forward;
        const StripSpan span{
            piece.from_m + (along ? low : high), piece.to_m - (along ? high : low), name};
        if (!spans.empty() && span.from_m - spans.back().to_m < touching_m) {
            spans.back().to_m = span.to_m;
        } else {
            spans.push_back(span);
        }
    }
    return spans;
}

std::vector<StripSpan> known_sections(const StoreReader& store,
                                      const std::vector<RouteSegment>& pieces,
                                      const Localisation& say) {
    std::vector<StripSpan> spans;
    const auto add = [&](const std::vector<StripSpan>& more) {
        spans.insert(spans.end(), more.begin(), more.end());
    };
    for (const auto& control : store.control_sections()) {
        add(spans_of(
            pieces,
            control.way_id,
            control.from_m,
            control.to_m,
            say("strip.control",
                {{"name", control.name}, {"iri", say.iri_with_unit(control.iri_mm_per_m)}})));
    }
    const auto surveys = store.surveys();
    std::set<std::pair<SegmentKey, std::size_t>> read;
    for (const auto& reading : store.reference_readings()) {
        read.emplace(reading.segment.key, reading.survey);
    }
    for (std::size_t survey = 0; survey < surveys.size(); ++survey) {
        constexpr double touching_m = 0.1;
        const auto name = say("strip.reference", {{"name", surveys[survey].name}});
        std::vector<StripSpan> of;
        for (const auto& piece : pieces) {
            if (!piece.segment || (!read.contains({*piece.segment, survey}) &&
                                   !read.contains({opposite(*piece.segment), survey}))) {
                continue;
            }
            if (!of.empty() && piece.from_m - of.back().to_m < touching_m) {
                of.back().to_m = piece.to_m;
            } else {
                of.push_back({piece.from_m, piece.to_m, name});
            }
        }
        add(of);
    }
    return spans;
}

/// Returns the part of a road's strip between two chainages.
Strip part_of(const Strip& whole, double from_m, double to_m) {
    Strip part{from_m, to_m, {}};
    for (const auto& row : whole.rows) {
        StripRow cut{row.title, {}};
        for (const auto& piece : row.pieces) {
            if (piece.to_m > from_m && piece.from_m < to_m) {
                cut.pieces.push_back(piece);
                cut.pieces.back().from_m = std::max(piece.from_m, from_m);
                cut.pieces.back().to_m = std::min(piece.to_m, to_m);
            }
        }
        part.rows.push_back(std::move(cut));
    }
    for (const auto& mark : whole.marks) {
        if (from_m <= mark.at_m && mark.at_m <= to_m) {
            part.marks.push_back(mark);
        }
    }
    for (const auto& span : whole.spans) {
        if (span.to_m > from_m && span.from_m < to_m) {
            part.spans.push_back(span);
        }
    }
    return part;
}

LinearRoute asked_road(const RoadNetwork& roads, const StripRoad& road) {
    return road.route
               ? route_between(roads, road.route->first, road.route->second, {.best = road.best})
               : route_along_way(roads, road.way_id.value_or(0), {}, {}, {});
}

} // namespace

std::vector<Strip> route_strips(const StoreReader& store,
                                const RoadNetwork& roads,
                                const StripRoad& road,
                                const SegmentFilter& filter,
                                const ClassTable& classes,
                                const Localisation& wording) {
    const auto route = asked_road(roads, road);
    const auto pieces = pieces_of(roads, route);
    const auto records = records_of(store, pieces, filter);
    const double whole_m = length_m(route);
    constexpr double shortest_m = 0.01;
    if (whole_m < shortest_m) {
        throw InputError{
            "the route has no length, expected two points at different places of a road"};
    }
    Strip whole{0, whole_m, {{wording("strip.along"), {}}, {wording("strip.against"), {}}}};
    for (const auto& piece : pieces) {
        for (std::size_t row = 0; piece.segment && row < whole.rows.size(); ++row) {
            const auto found = records.find(row == 0 ? *piece.segment : opposite(*piece.segment));
            if (found != records.end()) {
                whole.rows[row].pieces.push_back(
                    strip_piece(rated_length(found->second), classes, piece.from_m, piece.to_m));
            }
        }
    }
    if (whole.rows[1].pieces.empty()) {
        whole.rows.pop_back(); // a one-way road, or one driven in one direction
    }
    whole.marks = junctions_of(roads, route);
    whole.spans = known_sections(store, pieces, wording);

    const auto count = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::ceil(whole_m / max_strip_m)), 1, max_strips);
    const double strip_m = whole_m / static_cast<double>(count);
    std::vector<Strip> strips;
    for (std::size_t i = 0; i < count; ++i) {
        const double from_m = strip_m * static_cast<double>(i);
        const double to_m = strip_m * static_cast<double>(i + 1);
        strips.push_back(part_of(whole, from_m, to_m));
        strips.back().line = line_of(roads, route, from_m, to_m);
    }
    return strips;
}

} // namespace macadam
