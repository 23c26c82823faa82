#include "mapping/background/background_tiling.hpp"

#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"
#include "mapping/background/path_clipping.hpp"
#include "mapping/geometry/line_simplification.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Path = CellPath; ///< in cells of the whole level, up to 2^27

constexpr std::int32_t CellPoint::*axes[]{&CellPoint::x, &CellPoint::y};

CellPoint cell_of(const PackedPoint& point, const BackgroundLevel& level) {
    const auto place = tile_position(Unpacked{}(point), level.zoom);
    const double across = std::ldexp(background_cells, level.zoom);
    const auto cell = [&](double tiles) {
        return static_cast<std::int32_t>(
            std::clamp(std::round(tiles * background_cells), 0.0, across));
    };
    return {cell(place.x), cell(place.y)};
}

double distance_to_line(const CellPoint& point, const CellPoint& from, const CellPoint& to) {
    const double x = to.x - from.x;
    const double y = to.y - from.y;
    const double px = point.x - from.x;
    const double py = point.y - from.y;
    const double square = x * x + y * y;
    const double along = square > 0 ? std::clamp((px * x + py * y) / square, 0.0, 1.0) : 0;
    return std::hypot(px - along * x, py - along * y);
}

/// Keeps the points that a path needs. A ring is closed by its first point, repeated at its end.
Path simplified(const Path& path, bool is_ring, double tolerance) {
    if (path.size() < 3) {
        return path;
    }
    const auto last = path.size() - 1;
    std::vector<bool> kept(path.size(), false);
    kept.front() = kept.back() = true;
    const auto off = [&](std::size_t i, std::size_t from, std::size_t to) {
        return distance_to_line(path[i], path[from], path[to]);
    };
    std::size_t middle = 0;
    if (is_ring) { // in two parts, at the point farthest from the first
        const auto farther = [&](const CellPoint& a, const CellPoint& b) {
            return std::hypot(double(a.x) - path[0].x, double(a.y) - path[0].y) <
                   std::hypot(double(b.x) - path[0].x, double(b.y) - path[0].y);
        };
        middle = static_cast<std::size_t>(std::max_element(path.begin(), path.end(), farther) -
                                          path.begin());
        kept[middle] = true;
        keep_bends(0, middle, tolerance, off, kept);
    }
    keep_bends(middle, last, tolerance, off, kept);
    Path needed;
    for (std::size_t i = 0; i <= last; ++i) {
        if (kept[i]) {
            needed.push_back(path[i]);
        }
    }
    return needed;
}

/// Path of a feature in cells of a level, simplified; empty if too small. \param is_ring  then
/// clockwise
Path path_at(const std::vector<PackedPoint>& points, bool is_ring, const BackgroundLevel& level) {
    Path path;
    path.reserve(points.size() + 1);
    for (const auto& point : points) {
        const auto cell = cell_of(point, level);
        if (path.empty() || path.back() != cell) {
            path.push_back(cell);
        }
    }
    if (path.size() < 2 || !is_ring) {
        return path.size() < 2 ? Path{} : simplified(path, false, level.tolerance);
    }
    if (path.back() != path.front()) {
        path.push_back(path.front());
    }
    path = simplified(path, true, level.tolerance);
    path.pop_back();
    const auto area = path.size() < 3 ? 0 : twice_area(path);
    if (std::abs(area) < 2 * level.min_area) {
        return {};
    }
    if (area < 0) {
        std::reverse(path.begin(), path.end());
    }
    return path;
}

std::vector<Path>
within_tile(const std::vector<Path>& paths, bool are_lines, std::size_t axis, std::int64_t tile) {
    const auto low = static_cast<std::int32_t>(tile * background_cells);
    return paths_between(paths, are_lines, axes[axis], low, low + background_cells);
}

/// Range of tiles along an axis that paths and a limit have in common.
struct Range {
    std::int64_t first, last; ///< inclusive; last < first: none
};

Range range_of(const std::vector<Path>& paths, std::size_t axis, Range limit) {
    auto low = paths[0][0].*axes[axis];
    auto high = low;
    for (const auto& path : paths) {
        for (const auto& point : path) {
            low = std::min(low, point.*axes[axis]);
            high = std::max(high, point.*axes[axis]);
        }
    }
    return {std::max<std::int64_t>(limit.first, low / background_cells),
            std::min<std::int64_t>(limit.last, high / background_cells)};
}

/// Piece in cells of its tile; `std::nullopt` if it covers nothing.
std::optional<BackgroundPiece>
piece_of(BackgroundKind kind, std::vector<Path> paths, std::int64_t x, std::int64_t y) {
    if (!is_line_kind(kind)) {
        paths = rings_in_order(std::move(paths));
    }
    double area = 0;
    for (auto& path : paths) {
        area += is_line_kind(kind) ? 1 : twice_area(path);
        for (auto& point : path) {
            point.x -= static_cast<std::int32_t>(x * background_cells);
            point.y -= static_cast<std::int32_t>(y * background_cells);
        }
    }
    return area > 0 ? std::optional{BackgroundPiece{kind, std::move(paths)}} : std::nullopt;
}

std::vector<Path> paths_at(const BackgroundFeature& feature, const BackgroundLevel& level) {
    const bool is_ring = !is_line_kind(feature.kind);
    std::vector<Path> paths;
    for (std::size_t i = 0; i < feature.paths.size(); ++i) {
        auto path = path_at(feature.paths[i], is_ring, level);
        if (path.empty() && i == 0) {
            return {};
        }
        if (i > 0) {
            std::reverse(path.begin(), path.end());
        }
        if (!path.empty()) {
            paths.push_back(std::move(path));
        }
    }
    return paths;
}

} // namespace

std::optional<BackgroundPiece> piece_within(const BackgroundPiece& piece,
                                            const CellSquare& square) {
    const bool are_lines = is_line_kind(piece.kind);
    auto paths = paths_between(piece.paths, are_lines, axes[0], square.low, square.high);
    paths = paths_between(paths, are_lines, axes[1], square.low, square.high);
    return paths.empty() ? std::nullopt : piece_of(piece.kind, std::move(paths), 0, 0);
}

void BackgroundTiling::add(const BackgroundFeature& feature, const GeoBox& box) {
    constexpr std::size_t free_tiles = 1'000'000;
    constexpr std::size_t max_tiles_per_point = 4;
    constexpr std::size_t enough_bytes = std::size_t{32} << 20U;
    for (const auto& path : feature.paths) {
        points_ += path.size();
    }
    const bool are_lines = is_line_kind(feature.kind);
    for (const auto& level : background_levels) {
        if (!is_at_level(feature.kind, level)) {
            continue;
        }
        const auto paths = paths_at(feature, level);
        if (paths.empty()) {
            continue;
        }
        const auto tiles = tiles_of(box, level.zoom);
        const auto columns = range_of(paths, 0, {tiles.first_x, tiles.last_x});
        const auto all_rows = range_of(paths, 1, {tiles.first_y, tiles.last_y});
        if (columns.last < columns.first || all_rows.last < all_rows.first) {
            continue;
        }
        const auto count = static_cast<std::size_t>((columns.last - columns.first + 1) *
                                                    (all_rows.last - all_rows.first + 1));
        if (whole_tiles_ + count > free_tiles + max_tiles_per_point * points_) {
            continue;
        }
        whole_tiles_ += count;
        for (auto x = columns.first; x <= columns.last; ++x) {
            const auto column = within_tile(paths, are_lines, 0, x);
            if (column.empty()) {
                continue;
            }
            const auto rows = range_of(column, 1, all_rows);
            for (auto y = rows.first; y <= rows.last; ++y) {
                auto inside = within_tile(column, are_lines, 1, y);
                if (inside.empty()) {
                    continue;
                }
                if (const auto piece = piece_of(feature.kind, std::move(inside), x, y)) {
                    auto& bytes = tiles_[{
                        level.zoom, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)}];
                    const auto before = bytes.size();
                    append_piece(bytes, *piece);
                    bytes_ += bytes.size() - before;
                }
            }
        }
    }
    if (bytes_ > enough_bytes) {
        finish();
    }
}

void BackgroundTiling::finish() {
    for (const auto& [tile, pieces] : tiles_) {
        take_(tile, pieces);
    }
    tiles_.clear();
    bytes_ = 0;
}

} // namespace macadam
