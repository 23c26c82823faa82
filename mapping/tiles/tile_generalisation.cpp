#include "mapping/tiles/tile_generalisation.hpp"

#include "mapping/tiles/line_merging.hpp"
#include "mapping/tiles/line_simplification.hpp"
#include "mapping/tiles/run_joining.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace macadam {
namespace {

constexpr double tile_px = 256;

double length_of(std::span<const WorldPoint> line) {
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double x = double(line[i].x) - line[i - 1].x, y = double(line[i].y) - line[i - 1].y;
        length += std::sqrt(x * x + y * y);
    }
    return length;
}

// ----------------------------------------------------------------------------------------- runs

/// Part of a chain that becomes one line.
struct Run {
    RoadPart values; ///< its line is empty until the end
    double length;   ///< in world units
    std::size_t first_use, past_use;
};

bool is_alike(const Run& a, const Run& b, const ClassTable& table) {
    return a.values.validity == b.values.validity &&
           class_of(a.values, table) == class_of(b.values, table);
}

void join(Run& run, const Run& next) {
    add_values(run.values, next.values);
    if (next.length > run.length) { // the road takes the name of its longest part
        run.values.name = next.values.name;
        run.values.highway = next.values.highway;
    }
    run.length += next.length;
    run.past_use = next.past_use;
}

std::vector<Run> runs_of(const std::vector<RoadPart>& parts,
                         const std::vector<PartUse>& chain,
                         const ClassTable& table) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < chain.size(); ++i) {
        Run run{parts[chain[i].part], length_of(parts[chain[i].part].line), i, i + 1};
        run.values.line.clear();
        if (!runs.empty() && is_alike(runs.back(), run, table)) {
            join(runs.back(), run);
        } else {
            runs.push_back(std::move(run));
        }
    }
    return runs;
}

std::vector<WorldPoint> line_of(const std::vector<RoadPart>& parts, std::span<const PartUse> uses) {
    std::vector<WorldPoint> line;
    const auto add = [&](const WorldPoint& point) {
        if (line.empty() || line.back() != point) {
            line.push_back(point);
        }
    };
    for (const auto& [part, reversed] : uses) {
        const auto& points = parts[part].line;
        if (reversed) {
            std::for_each(points.rbegin(), points.rend(), add);
        } else {
            std::ranges::for_each(points, add);
        }
    }
    return line;
}

std::vector<RoadPart>
joined(const std::vector<RoadPart>& parts, const Generalisation& how, const ClassTable& table) {
    std::vector<RoadPart> joined;
    for (const auto& chain : part_chains(parts)) {
        auto runs = runs_of(parts, chain, table);
        join_short_runs(
            runs,
            how.min_run_px * how.pixel,
            [&](const Run& a, const Run& b) { return is_alike(a, b, table); },
            join,
            [](const Run& a, const Run& b) {
                return std::abs(iri_of(a.values) - iri_of(b.values));
            });
        for (auto& run : runs) {
            run.values.line = line_of(
                parts, std::span{chain}.subspan(run.first_use, run.past_use - run.first_use));
            joined.push_back(std::move(run.values));
        }
    }
    return joined;
}

// ---------------------------------------------------------------------------------------- cells

/// A square of the grid; directed parts also differ by direction.
struct Cell {
    std::uint32_t x, y;
    int direction;
    friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// Merges `part` with the part drawn in its square: the longer line stays.
void put_together(RoadPart& drawn, RoadPart part) {
    const auto order = [](const RoadPart& p) { return std::pair{-length_of(p.line), p.first}; };
    if (order(part) < order(drawn)) {
        std::swap(part, drawn);
    }
    add_values(drawn, part);
}

std::vector<RoadPart> drawn_by_cells(std::vector<RoadPart> parts, double side) {
    if (side < 1) {
        return parts;
    }
    std::vector<RoadPart> drawn;
    std::map<Cell, std::size_t> of_cell; // indices of drawn parts
    for (auto& part : parts) {
        const auto box = box_of(part.line);
        if (std::max(box.max_x - box.min_x, box.max_y - box.min_y) >= side) {
            drawn.push_back(std::move(part));
            continue;
        }
        const Cell cell{static_cast<std::uint32_t>(box.min_x / side),
                        static_cast<std::uint32_t>(box.min_y / side),
                        !part.is_directed    ? 0
                        : part.first.forward ? 1
                                             : 2};
        const auto [place, is_first] = of_cell.emplace(cell, drawn.size());
        if (is_first) {
            drawn.push_back(std::move(part));
        } else {
            put_together(drawn[place->second], std::move(part));
        }
    }
    return drawn;
}

// ----------------------------------------------------------------------------------- simplifying

void simplify(std::vector<RoadPart>& parts, double tolerance) {
    std::vector<WorldPoint> ends;
    for (const auto& part : parts) {
        ends.push_back(part.line.front());
        ends.push_back(part.line.back());
    }
    std::ranges::sort(ends);
    for (auto& part : parts) {
        if (part.line.size() > 2) {
            part.line = simplified(part.line, tolerance, [&](const WorldPoint& point) {
                return std::ranges::binary_search(ends, point);
            });
        }
    }
}

} // namespace

Generalisation generalisation_at(int zoom, int step) {
    assert(zoom >= 0 && zoom <= max_zoom && step >= 0);
    const double pixel = std::ldexp(1.0, world_bits - zoom) / tile_px;
    const bool is_nearest = zoom + 1 >= segments_from_zoom;
    const double coarser = std::ldexp(1.0, step);
    if (step == 0 && is_nearest) {
        return {.pixel = pixel, .min_run_px = 0, .cell_px = 0, .tolerance_px = 0.25};
    }
    return {.pixel = pixel,
            .min_run_px = 2 * coarser,
            .cell_px = 1 * coarser,
            .tolerance_px = 0.25 * std::min(coarser, 4.0)};
}

std::vector<RoadPart>
generalised(std::vector<RoadPart> parts, const Generalisation& how, const ClassTable& table) {
    std::ranges::sort(parts, {}, &RoadPart::first);
    auto drawn = drawn_by_cells(joined(parts, how, table), how.cell_px * how.pixel);
    simplify(drawn, how.tolerance_px * how.pixel);
    std::ranges::sort(drawn, {}, &RoadPart::first);
    return drawn;
}

} // namespace macadam
