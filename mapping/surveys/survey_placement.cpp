#include "mapping/surveys/survey_placement.hpp"

#include "estimator/common/angle.hpp"
#include "mapping/routes/line_matching.hpp"
#include "mapping/surveys/survey_line.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

namespace macadam {
namespace {

constexpr double same_place_m = 0.01;
constexpr double max_apart_m = 15;        // between the end of a row and the start of the next
constexpr double sharpest_turn_deg = 120; // between rows of one line; more is a return trip
constexpr double shortest_part_m = 1e-3;

// ------------------------------------------------------------------------------------ by ways

std::optional<WayView> find_way(const RoadNetwork& roads, std::int64_t way_id) {
    const auto ways = roads.ways.first(way_count(roads));
    const auto found = std::ranges::lower_bound(ways, way_id, {}, &PackedWay::id);
    return found == ways.end() || found->id != way_id
               ? std::nullopt
               : std::optional{way_at(roads, static_cast<std::uint32_t>(found - ways.begin()))};
}

/// Returns the overlaps of a way interval with the segments of one link.
std::vector<ReferencePart> parts_on(const Link& link, const WayPart& part, std::size_t row) {
    std::vector<ReferencePart> parts;
    const double segment_m = (link.to_m - link.from_m) / link.segments;
    for (std::uint32_t i = 0; i < link.segments; ++i) {
        const double from_m = std::max(part.from_m, link.from_m + i * segment_m);
        const double to_m = std::min(part.to_m, link.from_m + (i + 1) * segment_m);
        if (to_m - from_m > shortest_part_m) {
            parts.push_back({.row = row,
                             .segment = {part.way_id, part.forward, link.first_segment + i},
                             .segment_m = segment_m,
                             .row_m = part.to_m - part.from_m,
                             .from_m = from_m,
                             .to_m = to_m,
                             .confidence = 1});
        }
    }
    return parts;
}

void place_on_way(const RoadNetwork& roads,
                  const WayPart& part,
                  std::size_t row,
                  LocatedReference& placed) {
    const auto way = find_way(roads, part.way_id);
    placed.unplaced[row] = way ? "beyond_way" : "no_such_way";
    for (auto i = way ? way->first_link : 0; way && i < way->past_link; ++i) {
        const auto parts = parts_on(link_at(roads, LinkId{i}), part, row);
        if (parts.empty()) {
            continue;
        }
        if (!is_drivable(roads, edge_of(LinkId{i}, part.forward))) {
            placed.unplaced[row] = "not_drivable";
            continue;
        }
        placed.parts.insert(placed.parts.end(), parts.begin(), parts.end());
    }
}

// ------------------------------------------------------------------------------ by coordinates

/// Rows on a driven line, as metres along it.
struct DrivenLine {
    std::vector<GeoPoint> line;
    std::vector<SurveyPiece> pieces;
};

/// The straight line of a row, in driving direction.
struct Stick {
    std::size_t row;
    GeoPoint begin;
    GeoPoint end;
};

/// Returns the point at a distance and heading; accurate enough for the length of a row.
GeoPoint place_at(const GeoPoint& from, double heading_deg, double distance_m) {
    const double heading_rad = heading_deg * rad_per_deg;
    return LocalFrame{from}.to_geo(
        {distance_m * std::sin(heading_rad), distance_m * std::cos(heading_rad)});
}

std::vector<Stick> sticks_of(const ReferenceSurvey& survey) {
    std::vector<Stick> sticks;
    for (std::size_t row = 0; row < survey.rows.size(); ++row) {
        const auto& [values, placed, way, begin, end, heading_deg] = survey.rows[row];
        if (placed && begin && end) {
            sticks.push_back({row, *begin, *end});
        } else if (placed && heading_deg) {
            const double half_m = values.length_m.value_or(0) / 2;
            sticks.push_back({row,
                              place_at(values.at, *heading_deg, -half_m),
                              place_at(values.at, *heading_deg, half_m)});
        }
    }
    return sticks;
}

/// Returns true if a car that drove the first may have continued over the second.
bool follows(const Stick& before, const Stick& after) {
    const double turn_deg = std::abs(std::remainder(
        course_deg(after.begin, after.end) - course_deg(before.begin, before.end), 360));
    return distance_m(before.end, after.begin) <= max_apart_m && turn_deg <= sharpest_turn_deg;
}

/// Groups the lines of one drive in the order of travel, whatever the order of the file.
std::vector<std::deque<Stick>> chains_of(const std::vector<Stick>& sticks) {
    std::vector<std::deque<Stick>> chains;
    for (const auto& stick : sticks) {
        const bool ahead = !chains.empty() && follows(chains.back().back(), stick);
        const bool behind = !chains.empty() && follows(stick, chains.back().front());
        const bool nearer_behind =
            behind && (!ahead || distance_m(stick.end, chains.back().front().begin) <
                                     distance_m(chains.back().back().end, stick.begin));
        if (nearer_behind) {
            chains.back().push_front(stick);
        } else if (ahead) {
            chains.back().push_back(stick);
        } else {
            chains.push_back({stick});
        }
    }
    return chains;
}

DrivenLine line_of_chain(const std::deque<Stick>& chain) {
    DrivenLine driven{.line = {chain.front().begin}, .pieces = {}};
    double along_m = 0;
    const auto go_to = [&](const GeoPoint& place) {
        if (const double step_m = distance_m(driven.line.back(), place); step_m > same_place_m) {
            driven.line.push_back(place);
            along_m += step_m;
        }
        return along_m;
    };
    for (const auto& stick : chain) {
        const double from_m = go_to(stick.begin);
        driven.pieces.push_back({stick.row, from_m, go_to(stick.end)});
    }
    return driven;
}

std::vector<DrivenLine> lines_of_sticks(const ReferenceSurvey& survey) {
    std::vector<DrivenLine> lines;
    for (const auto& chain : chains_of(sticks_of(survey))) {
        lines.push_back(line_of_chain(chain));
    }
    return lines;
}

/// Vertices of a line of midpoints, with their distances along it in the plane and on the
/// ellipsoid.
struct Vertices {
    std::vector<GeoPoint> places;
    std::vector<double> plane_m;
    std::vector<double> along_m;

    double along_of(double at_m) const {
        const auto after = std::ranges::upper_bound(plane_m, at_m) - plane_m.begin();
        const auto last = static_cast<std::ptrdiff_t>(plane_m.size()) - 1;
        const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after, 1, last));
        const double share = (at_m - plane_m[i - 1]) / (plane_m[i] - plane_m[i - 1]);
        return std::lerp(along_m[i - 1], along_m[i], share);
    }
};

void add_vertex(Vertices& vertices, const GeoPoint& place, double plane_m) {
    const double step_m = vertices.places.empty() ? 0 : distance_m(vertices.places.back(), place);
    vertices.along_m.push_back(vertices.along_m.empty() ? 0 : vertices.along_m.back() + step_m);
    vertices.places.push_back(place);
    vertices.plane_m.push_back(plane_m);
}

std::vector<DrivenLine> lines_of_middles(const ReferenceSurvey& survey) {
    std::vector<SurveyRow> rows;
    std::vector<std::size_t> numbers;
    for (std::size_t row = 0; row < survey.rows.size(); ++row) {
        if (survey.rows[row].placed) {
            rows.push_back(survey.rows[row].values);
            numbers.push_back(row);
        }
    }
    if (rows.empty()) {
        return {};
    }
    const LocalFrame frame{rows.front().at};
    const auto joined = survey_lines(rows, frame);
    std::vector<Vertices> vertices(joined.lines.size());
    for (const auto& leg : joined.legs) {
        auto& of_line = vertices[leg.line];
        if (of_line.places.empty()) {
            add_vertex(of_line, frame.to_geo(leg.begin), leg.begin_m);
        }
        const double leg_m =
            std::hypot(leg.end.east_m - leg.begin.east_m, leg.end.north_m - leg.begin.north_m);
        add_vertex(of_line, frame.to_geo(leg.end), leg.begin_m + leg_m);
    }
    std::vector<DrivenLine> lines;
    for (std::size_t i = 0; i < joined.lines.size(); ++i) {
        DrivenLine line{.line = vertices[i].places, .pieces = {}};
        for (const auto& [row, from_m, to_m] : joined.lines[i].pieces) {
            line.pieces.push_back(
                {numbers[row], vertices[i].along_of(from_m), vertices[i].along_of(to_m)});
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

/// Returns the overlap of a row with a matched part of its line.
std::optional<ReferencePart> shared(const SurveyPiece& piece, const LinePart& part) {
    const double from_m = std::max(piece.from_m, part.from_line_m);
    const double to_m = std::min(piece.to_m, part.to_line_m);
    if (to_m - from_m <= shortest_part_m) {
        return std::nullopt;
    }
    const auto station = [&](double line_m) {
        return std::lerp(part.from_station_m,
                         part.to_station_m,
                         (line_m - part.from_line_m) / (part.to_line_m - part.from_line_m));
    };
    const double first_m = station(from_m);
    const double last_m = station(to_m);
    const bool forward = part.segment.forward;
    return ReferencePart{.row = piece.row,
                         .segment = part.segment,
                         .segment_m = part.segment_m,
                         .row_m = piece.to_m - piece.from_m,
                         .from_m = forward ? first_m : -last_m,
                         .to_m = forward ? last_m : -first_m,
                         .confidence = part.confidence};
}

void place_line(const RoadNetwork& roads, const DrivenLine& line, LocatedReference& placed) {
    const auto matched = line_parts(roads, line.line);
    for (const auto& piece : line.pieces) {
        placed.unplaced[piece.row] = "off_network";
        auto part = std::ranges::upper_bound(matched, piece.from_m, {}, &LinePart::to_line_m);
        for (; part != matched.end() && part->from_line_m < piece.to_m; ++part) {
            if (const auto found = shared(piece, *part); found && found->to_m > found->from_m) {
                placed.parts.push_back(*found);
            }
        }
    }
}

} // namespace

LocatedReference placed_on(const RoadNetwork& roads, const ReferenceSurvey& survey) {
    const bool sticks = survey.places == ReferenceLocation::ends ||
                        std::ranges::any_of(survey.rows, [](const ReferenceRow& row) {
                            return row.heading_deg.has_value();
                        });
    LocatedReference placed;
    for (const auto& row : survey.rows) {
        placed.unplaced.emplace_back(row.placed ? "no_neighbour" : "no_place");
    }
    if (survey.places == ReferenceLocation::on_ways) {
        for (std::size_t row = 0; row < survey.rows.size(); ++row) {
            if (const auto& way = survey.rows[row].way) {
                place_on_way(roads, *way, row, placed);
            }
        }
    } else {
        for (const auto& line : sticks ? lines_of_sticks(survey) : lines_of_middles(survey)) {
            place_line(roads, line, placed);
        }
    }
    for (const auto& part : placed.parts) {
        placed.unplaced[part.row] = "";
    }
    std::ranges::stable_sort(placed.parts, {}, &ReferencePart::row);
    return placed;
}

} // namespace macadam
