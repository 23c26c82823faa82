#include "render/background/background_shapes.hpp"

#include "mapping/background/background_levels.hpp"
#include "render/background/line_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace macadam {
namespace {

using Path = std::vector<PixelPoint>;

/// Widths of lines at 1000 px.
double width_of(BackgroundKind kind, const BackgroundLook& look) {
    const bool is_large = look.denominator <= background_levels[0].max_denominator;
    switch (kind) {
    case BackgroundKind::river:
        return is_large ? 1.6 : 1;
    case BackgroundKind::stream:
        return 0.7;
    case BackgroundKind::railway:
        return is_large ? 1.1 : 0.8;
    default:
        return 0.7; // sidings
    }
}

/// Length of a dash with its gap at 1000 px; 0: drawn through.
double period_of(BackgroundKind kind) {
    constexpr double railway_period = 6;
    return kind == BackgroundKind::railway || kind == BackgroundKind::siding ? railway_period : 0;
}

/// Projects the points of a tile. Points on common sides of tiles get the same position.
class TileProjection {
public:
    TileProjection(const TileId& tile, const MapFrame& frame, double middle_deg)
        : frame_{frame}, tile_{tile}, middle_deg_{middle_deg} {}

    PixelPoint operator()(const CellPoint& point) const {
        const auto cells = [](std::uint32_t tile, std::int32_t cell) {
            return (double(tile) * background_cells + cell) / background_cells;
        };
        auto at = geo_point({cells(tile_.x, point.x), cells(tile_.y, point.y)}, tile_.zoom);
        at.lon_deg += 360 * std::round((middle_deg_ - at.lon_deg) / 360);
        return to_pixel(frame_, at);
    }

private:
    const MapFrame& frame_;
    TileId tile_;
    double middle_deg_;
};

/// Box around rings; `std::nullopt` if a point lies outside the domain of the projection.
std::optional<PixelBox> box_of(const std::vector<Path>& rings) {
    std::optional<PixelBox> box;
    for (const auto& ring : rings) {
        for (const auto& point : ring) {
            if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
                return std::nullopt;
            }
            if (!box) {
                box = PixelBox{point.x, point.y, point.x, point.y};
            }
            box->left = std::min(box->left, point.x);
            box->top = std::min(box->top, point.y);
            box->right = std::max(box->right, point.x);
            box->bottom = std::max(box->bottom, point.y);
        }
    }
    return box;
}

bool meet(const PixelBox& a, const PixelBox& b) {
    return a.left <= b.right && b.left <= a.right && a.top <= b.bottom && b.top <= a.bottom;
}

bool is_shown(BackgroundKind kind, const BackgroundLook& look) {
    return kind != BackgroundKind::building || look.denominator <= building_denominator;
}

std::vector<Path>
outlines_of(BackgroundKind kind, const std::vector<Path>& lines, const BackgroundLook& look) {
    std::vector<Path> rings;
    for (const auto& line : lines) {
        append_outline(rings,
                       line,
                       {.radius_px = width_of(kind, look) * look.unit / 2,
                        .period_px = period_of(kind) * look.unit});
    }
    return rings;
}

} // namespace

std::vector<BackgroundShape> background_shapes(std::span<const BackgroundTile> tiles,
                                               const MapFrame& frame,
                                               const PixelBox& room,
                                               const BackgroundLook& look,
                                               double middle_deg) {
    std::vector<BackgroundShape> shapes;
    for (const auto& tile : tiles) {
        const TileProjection project{tile.tile, frame, middle_deg};
        visit_pieces(tile.pieces, [&](const BackgroundPiece& piece) {
            if (!is_shown(piece.kind, look)) {
                return;
            }
            std::vector<Path> paths;
            paths.reserve(piece.paths.size());
            for (const auto& path : piece.paths) {
                auto& pixels = paths.emplace_back();
                pixels.reserve(path.size());
                std::transform(path.begin(), path.end(), std::back_inserter(pixels), project);
            }
            const auto around = box_of(paths);
            if (!around || !meet(*around, room)) {
                return;
            }
            if (is_line_kind(piece.kind)) {
                paths = outlines_of(piece.kind, paths, look);
            }
            if (const auto box = box_of(paths)) {
                shapes.push_back({piece.kind, *box, std::move(paths)});
            }
        });
    }
    std::stable_sort(
        shapes.begin(), shapes.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
    return shapes;
}

} // namespace macadam
