// The painter beside a rasteriser that knows nothing of OpenGL, of quads or of tiles: for every
// pixel and every road it takes the least distance to any of the road's pieces, by brute force and
// in double precision, and blends without rounding.

#include "render/roads/line_widths.hpp"
#include "render/scene/colour.hpp"
#include "render/tiles/tile_painter.hpp"
#include "tile_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr int side_px = 256;
constexpr int zoom = 16;
constexpr TileId tile{zoom, 35000, 22500};

/// A road through places in pixels, piece by piece of one class.
struct Road {
    std::vector<PointEn> places;
    std::vector<int> classes; ///< of each piece; -1 throughout: not measured
    bool certain = true;
    int rank = 3;
    bool paired = false; ///< one of two directions: drawn beside its places
};

using Colour = std::array<double, 3>;

Colour colour_of(std::uint32_t rgb) {
    return {double(rgb >> 16 & 255U), double(rgb >> 8 & 255U), double(rgb & 255U)};
}

double cross(const PointEn& a, const PointEn& b) {
    return a.east_m * b.north_m - a.north_m * b.east_m;
}

PointEn minus(const PointEn& a, const PointEn& b) {
    return {a.east_m - b.east_m, a.north_m - b.north_m};
}

PointEn plus(const PointEn& a, const PointEn& b, double times) {
    return {a.east_m + times * b.east_m, a.north_m + times * b.north_m};
}

PointEn unit(const PointEn& a) {
    const double length = std::hypot(a.east_m, a.north_m);
    return {a.east_m / length, a.north_m / length};
}

/// y grows downwards.
PointEn right_of(const PointEn& direction) {
    return {-direction.north_m, direction.east_m};
}

/// The corners of the lines that run beside the pieces: where these lines cross.
std::vector<PointEn> beside(const std::vector<PointEn>& places, double right_px) {
    std::vector<PointEn> moved;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto before = unit(
            minus(places[std::max<std::size_t>(i, 1)], places[std::max<std::size_t>(i, 1) - 1]));
        const auto next = std::min(i, places.size() - 2);
        const auto after = unit(minus(places[next + 1], places[next]));
        const auto on_first = plus(places[i], right_of(before), right_px);
        const auto on_second = plus(places[i], right_of(after), right_px);
        const double sine = cross(before, after);
        moved.push_back(
            std::abs(sine) < 1e-9
                ? on_first
                : plus(on_first, before, cross(minus(on_second, on_first), after) / sine));
    }
    return moved;
}

double distance_px(const PointEn& a, const PointEn& b, const PointEn& at) {
    const auto way = minus(b, a);
    const auto part = minus(at, a);
    const double squared = way.east_m * way.east_m + way.north_m * way.north_m;
    const double t =
        std::clamp((part.east_m * way.east_m + part.north_m * way.north_m) / squared, 0.0, 1.0);
    const auto off = minus(part, {way.east_m * t, way.north_m * t});
    return std::hypot(off.east_m, off.north_m);
}

/// Of a window one pixel wide across a line, so far from its middle: what lies on the line.
double covered(double away_px, double radius_px) {
    return std::clamp(
        std::min(away_px + 0.5, radius_px) - std::max(away_px - 0.5, -radius_px), 0.0, 1.0);
}

/// How far a pixel lies beyond the line that halves the bend at places[i], onwards.
double beyond_px(const std::vector<PointEn>& places, std::size_t i, const PointEn& at) {
    const auto onward =
        unit(plus(unit(minus(places[i], places[i - 1])), unit(minus(places[i + 1], places[i])), 1));
    const auto part = minus(at, places[i]);
    return part.east_m * onward.east_m + part.north_m * onward.north_m;
}

class Raster {
public:
    explicit Raster(std::uint32_t ground)
        : pixels_(std::size_t(side_px) * side_px, colour_of(ground)) {}

    /// Where a run ends: nothing goes on, and its end is round; a neighbour that is painted
    /// earlier, over which it ends softly on the line that halves the bend; one that is painted
    /// later, under which it goes on for a pixel.
    enum class End { open, over, under };

    /// The pieces first .. past - 1 of a road, as one.
    struct Run {
        std::size_t first, past;
        End start = End::open;
        End end = End::open;
    };

    void
    paint(const std::vector<PointEn>& places, const Run& run, double radius_px, std::uint32_t rgb) {
        const auto above = colour_of(rgb);
        for (int y = 0; y < side_px; ++y) {
            for (int x = 0; x < side_px; ++x) {
                const PointEn at{x + 0.5, y + 0.5};
                double away_px = 1e9;
                for (std::size_t i = run.first; i < run.past; ++i) {
                    const auto step = unit(minus(places[i + 1], places[i]));
                    const bool cut_before = i == run.first && run.start != End::open;
                    const bool cut_after = i + 1 == run.past && run.end != End::open;
                    away_px = std::min(away_px,
                                       distance_px(plus(places[i], step, cut_before ? -2 : 0),
                                                   plus(places[i + 1], step, cut_after ? 2 : 0),
                                                   at));
                }
                double share = covered(away_px, radius_px);
                if (share > 0 && run.start != End::open) {
                    share *= left_over(run.start, -beyond_px(places, run.first, at));
                }
                if (share > 0 && run.end != End::open) {
                    share *= left_over(run.end, beyond_px(places, run.past, at));
                }
                auto& pixel = pixels_[std::size_t(y) * side_px + std::size_t(x)];
                for (std::size_t c = 0; c < 3; ++c) {
                    pixel[c] += (above[c] - pixel[c]) * share;
                }
            }
        }
    }

    double max_difference(const Image& image) const {
        double most = 0;
        for (std::size_t i = 0; i < image.rgb.size(); ++i) {
            most = std::max(most, std::abs(pixels_[i / 3][i % 3] - image.rgb[i]));
        }
        return most;
    }

private:
    static double left_over(End end, double beyond_px) {
        return end == End::over ? std::clamp(0.5 - beyond_px, 0.0, 1.0) : beyond_px < 1 ? 1.0 : 0.0;
    }

    std::vector<Colour> pixels_;
};

/// Runs of one class; what is better goes on under what is worse.
std::vector<Raster::Run> runs_of(const Road& road, int iri_class) {
    std::vector<Raster::Run> runs;
    const auto& classes = road.classes;
    for (std::size_t i = 0; i < classes.size(); ++i) {
        if (classes[i] != iri_class) {
            continue;
        }
        auto past = i;
        while (past < classes.size() && classes[past] == iri_class) {
            ++past;
        }
        const auto end_at = [&](bool has_neighbour, std::size_t neighbour) {
            return !has_neighbour                   ? Raster::End::open
                   : classes[neighbour] < iri_class ? Raster::End::over
                                                    : Raster::End::under;
        };
        runs.push_back({i, past, end_at(i > 0, i - 1), end_at(past < classes.size(), past)});
        i = past;
    }
    return runs;
}

Raster rastered(const std::vector<Road>& roads) {
    const auto widths = tile_widths(zoom);
    const auto colours = palette(MapStyle::Theme::light);
    const auto ramp = ramp_colours("rdylbu", 3);
    Raster raster{colours.ground};
    const auto each = [&](int rank, bool measured, auto use) {
        for (const auto& road : roads) {
            if (road.rank == rank && (road.classes.front() >= 0) == measured) {
                use(road,
                    road.paired ? beside(road.places, way_offset_px(widths, rank)) : road.places);
            }
        }
    };
    for (int rank = 5; rank >= 0; --rank) {
        each(rank, false, [&](const Road& road, const std::vector<PointEn>& places) {
            raster.paint(places,
                         {0, road.classes.size()},
                         0.75 * core_radius_px(widths, rank, true),
                         colours.unmeasured);
        });
    }
    for (int rank = 5; rank >= 0; --rank) {
        for (const bool certain : {false, true}) {
            each(rank, true, [&](const Road& road, const std::vector<PointEn>& places) {
                if (road.certain == certain) {
                    raster.paint(places,
                                 {0, road.classes.size()},
                                 casing_radius_px(widths, rank, certain),
                                 colours.casing);
                }
            });
        }
        for (int iri_class = 0; iri_class < 3; ++iri_class) {
            for (const bool certain : {false, true}) {
                each(rank, true, [&](const Road& road, const std::vector<PointEn>& places) {
                    for (const auto& run : runs_of(road, iri_class)) {
                        if (road.certain == certain) {
                            raster.paint(places,
                                         run,
                                         core_radius_px(widths, rank, certain),
                                         ramp[std::size_t(iri_class)]);
                        }
                    }
                });
            }
        }
    }
    return raster;
}

Image painted(const std::vector<Road>& roads) {
    std::vector<MapLine> lines;
    for (const auto& road : roads) {
        for (std::size_t i = 0; i < road.classes.size(); ++i) {
            auto line = line_at(window_of(tile, side_px, 1),
                                {road.places[i], road.places[i + 1]},
                                road.classes[i],
                                road.rank);
            line.certain = road.certain;
            line.both_ways = road.paired;
            lines.push_back(std::move(line));
        }
    }
    TilePainter painter{{{}, side_px, 1}};
    return painter.draw(tile, lines);
}

double max_difference(const std::vector<Road>& roads) {
    return rastered(roads).max_difference(painted(roads));
}

// Eight bits hold a channel, and the share of each layer, to half a level; three layers lie on each
// other where a road has its casing and its core above ground. A mitre reaches r (1 / cos(bend / 2)
// - 1) beyond the round corner of the oracle: 0.007 px, or 2 of 255 levels, for a casing of 5.5 px
// and the largest bend, 0.1 rad.
constexpr double max_levels = 4;

/// A gently winding road; no bend is tighter than the line is wide.
Road winding(std::mt19937& random, int pieces) {
    std::uniform_real_distribution<double> turn{-0.1, 0.1};
    std::uniform_real_distribution<double> length_px{14, 30};
    std::uniform_real_distribution<double> anywhere{20, 236};
    Road road;
    PointEn at{anywhere(random), anywhere(random)};
    double course = 30 * turn(random);
    road.places.push_back(at);
    for (int i = 0; i < pieces; ++i) {
        const double step_px = length_px(random);
        at = {at.east_m + step_px * std::cos(course), at.north_m + step_px * std::sin(course)};
        road.places.push_back(at);
        course += turn(random);
    }
    return road;
}

} // namespace

TEST(TileRaster, AgreesOnARoadOfOneClass) {
    std::mt19937 random{1};
    for (int i = 0; i < 12; ++i) {
        auto road = winding(random, 5);
        road.classes.assign(5, i % 3);
        road.certain = i % 2 == 0;
        road.rank = i % 6;
        EXPECT_LE(max_difference({road}), max_levels) << i;
    }
}

TEST(TileRaster, AgreesOnRoadsWithoutAMeasurement) {
    std::mt19937 random{2};
    for (int i = 0; i < 6; ++i) {
        auto road = winding(random, 6);
        road.classes.assign(6, -1);
        road.rank = i;
        EXPECT_LE(max_difference({road}), max_levels) << i;
    }
}

TEST(TileRaster, AgreesOnEachDirectionAtItsSide) {
    std::mt19937 random{3};
    for (int i = 0; i < 6; ++i) {
        auto road = winding(random, 5);
        road.classes.assign(5, i % 3);
        road.paired = true;
        EXPECT_LE(max_difference({road}), max_levels) << i;
    }
}

TEST(TileRaster, AgreesWhereTheClassChanges) {
    std::mt19937 random{4};
    for (int i = 0; i < 12; ++i) {
        auto road = winding(random, 6);
        for (std::size_t k = 2; k < road.places.size(); ++k) {
            const auto step = unit(minus(road.places[k - 1], road.places[k - 2]));
            road.places[k] = plus(plus(road.places[k - 1], step, 20), right_of(step), i % 3 - 1);
        }
        road.classes = {0, 0, 2, 2, 1, 1};
        EXPECT_LE(max_difference({road}), max_levels) << i;
    }
}

TEST(TileRaster, AgreesOnCrossingsOfRoadsOfAllRanks) {
    std::vector<Road> roads;
    for (int rank = 0; rank < 6; ++rank) {
        const double course = 0.3 + 0.5 * rank;
        const PointEn step{110 * std::cos(course), 110 * std::sin(course)};
        roads.push_back({{plus({128, 128}, step, -1), plus({128, 128}, step, 1)},
                         {rank % 4 - 1},
                         rank % 2 == 0,
                         rank,
                         false});
    }
    EXPECT_LE(max_difference(roads), max_levels);
}

TEST(TileRaster, WouldNoticeALineATenthOfAPixelTooWide) {
    const Road road{{{20, 30}, {230, 200}}, {1}, true, 3, false};
    const auto widths = tile_widths(zoom);
    const auto colours = palette(MapStyle::Theme::light);
    Raster raster{colours.ground};
    raster.paint(road.places, {0, 1}, casing_radius_px(widths, 3, true) + 0.05, colours.casing);
    raster.paint(
        road.places, {0, 1}, core_radius_px(widths, 3, true), ramp_colours("rdylbu", 3)[1]);
    EXPECT_GT(raster.max_difference(painted({road})), max_levels);
}

} // namespace macadam::testing
