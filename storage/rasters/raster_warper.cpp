#include "storage/rasters/raster_warper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr int feet_at_once = 1 << 19;            // 13 MB of footprints
constexpr std::int64_t pixels_at_once = 1 << 23; // of the raster, 32 MB
constexpr double farthest_px = 32; // of a level: near a pole, a pixel may extend around the globe

/// Inline replacement of std::floor, which is a function call.
int floor_of(double value) {
    const int truncated = int(value);
    return truncated - (value < truncated ? 1 : 0);
}

/// Filter support along one axis of a level: pixels [first, end) around `middle`.
struct Reach {
    double middle, per_radius;
    int first, end;

    double weight(int pixel) const { return 1 - std::abs(pixel + 0.5 - middle) * per_radius; }
};

Reach reach_of(double middle_px, double foot_px, int level_px) {
    const double radius = std::clamp(foot_px, 1.0, farthest_px);
    return {middle_px,
            1 / radius,
            std::max(0, floor_of(middle_px - radius - 0.5) + 1),
            std::min(level_px, -floor_of(0.5 - middle_px - radius))};
}

/// Mean of colours weighted by opacity and distance.
class ColourMean {
public:
    void add(const std::uint8_t* rgba, double weight) {
        const double opaque = weight * rgba[3];
        red_ += opaque * rgba[0];
        green_ += opaque * rgba[1];
        blue_ += opaque * rgba[2];
        alpha_ += opaque;
        weight_ += weight;
    }

    void put(std::uint8_t* rgba) const {
        if (alpha_ > 0) {
            const double share = 1 / alpha_;
            rgba[0] = std::uint8_t(red_ * share + 0.5);
            rgba[1] = std::uint8_t(green_ * share + 0.5);
            rgba[2] = std::uint8_t(blue_ * share + 0.5);
            rgba[3] = std::uint8_t(alpha_ / weight_ + 0.5);
        }
    }

private:
    double red_ = 0, green_ = 0, blue_ = 0, alpha_ = 0, weight_ = 0;
};

/// Renders some rows of a picture, part by part.
class RowPainting {
public:
    RowPainting(const RasterFile& raster,
                const RasterLevel& level,
                const PicturePart& rows,
                std::vector<PixelFootprint> feet,
                std::uint8_t* rgba)
        : raster_{raster}, width_px_{raster.width_px()},
          height_px_{raster.height_px()}, level_{level}, per_raster_px_x_{1 / level.per_px_x},
          per_raster_px_y_{1 / level.per_px_y}, rows_{rows}, feet_{std::move(feet)}, rgba_{rgba} {}

    /// Renders a part, in halves if it needs too many pixels of the raster.
    void paint(const PicturePart& part) {
        const auto box = box_of(part);
        if (box.width_px <= 0 || box.height_px <= 0) {
            return;
        }
        const bool fits = std::int64_t{box.width_px} * box.height_px <= pixels_at_once;
        if (fits || (part.width_px == 1 && part.height_px == 1)) {
            paint_from(part, box);
        } else if (part.width_px > 1) {
            const int half = part.width_px / 2;
            paint({part.left_px, part.top_px, half, part.height_px});
            paint({part.left_px + half, part.top_px, part.width_px - half, part.height_px});
        } else {
            const int half = part.height_px / 2;
            paint({part.left_px, part.top_px, 1, half});
            paint({part.left_px, part.top_px + half, 1, part.height_px - half});
        }
    }

private:
    std::size_t index(int x, int y) const {
        return std::size_t(y - rows_.top_px) * std::size_t(rows_.width_px) +
               std::size_t(x - rows_.left_px);
    }

    bool is_inside(const PixelFootprint& foot) const { // false if it is undefined
        return foot.x >= 0 && foot.x <= width_px_ && foot.y >= 0 && foot.y <= height_px_;
    }

    Reach across(double x, double foot_px) const {
        return reach_of(x * per_raster_px_x_, foot_px * per_raster_px_x_, level_.width_px);
    }

    Reach along(double y, double foot_px) const {
        return reach_of(y * per_raster_px_y_, foot_px * per_raster_px_y_, level_.height_px);
    }

    template <typename Visit>
    void visit(const PicturePart& part, Visit visitor) const {
        for (int y = part.top_px; y < part.top_px + part.height_px; ++y) {
            for (int x = part.left_px; x < part.left_px + part.width_px; ++x) {
                if (const auto& foot = feet_[index(x, y)]; is_inside(foot)) {
                    visitor(index(x, y), foot);
                }
            }
        }
    }

    /// Pixels of the level that a part needs, with a margin if its footprints differ.
    RasterBox box_of(const PicturePart& part) const {
        constexpr double far = std::numeric_limits<double>::infinity();
        PixelFootprint least{far, far, 0, 0};
        PixelFootprint most{-far, -far, 0, 0};
        visit(part, [&](std::size_t, const PixelFootprint& foot) {
            least.x = std::min(least.x, foot.x);
            least.y = std::min(least.y, foot.y);
            most.x = std::max(most.x, foot.x);
            most.y = std::max(most.y, foot.y);
            most.width_px = std::max(most.width_px, foot.width_px);
            most.height_px = std::max(most.height_px, foot.height_px);
        });
        if (least.x > most.x) {
            return {};
        }
        const int left = across(least.x, most.width_px).first;
        const int top = along(least.y, most.height_px).first;
        return {left,
                top,
                across(most.x, most.width_px).end - left,
                along(most.y, most.height_px).end - top};
    }

    void paint_from(const PicturePart& part, const RasterBox& box) {
        const auto source = raster_.rgba(level_, box);
        const auto row_bytes = std::size_t(box.width_px) * 4;
        std::array<double, std::size_t(2 * farthest_px) + 2> weights{};
        visit(part, [&](std::size_t pixel, const PixelFootprint& foot) {
            const auto columns = across(foot.x, foot.width_px);
            const auto rows = along(foot.y, foot.height_px);
            const int count = columns.end - columns.first;
            for (int i = 0; i < count; ++i) {
                weights[std::size_t(i)] = columns.weight(columns.first + i);
            }
            ColourMean mean;
            for (int y = rows.first; y < rows.end; ++y) {
                const double weight = rows.weight(y);
                const auto* from = source.data() + std::size_t(y - box.top_px) * row_bytes +
                                   std::size_t(columns.first - box.left_px) * 4;
                for (int i = 0; i < count; ++i, from += 4) {
                    mean.add(from, weights[std::size_t(i)] * weight);
                }
            }
            mean.put(rgba_ + pixel * 4);
        });
    }

    const RasterFile& raster_;
    int width_px_, height_px_;
    const RasterLevel& level_;
    double per_raster_px_x_, per_raster_px_y_;
    PicturePart rows_;
    std::vector<PixelFootprint> feet_;
    std::uint8_t* rgba_;
};

} // namespace

RasterWarper::RasterWarper(std::shared_ptr<const RasterFile> raster, const PicturePlane& plane)
    : raster_{std::move(raster)}, transform_{plane, *raster_} {
    level_ = raster_->level(transform_.min_foot_px().value_or(1));
}

std::vector<std::uint8_t> RasterWarper::rgba(const PicturePart& part) const {
    const auto row_bytes = std::size_t(part.width_px) * 4;
    std::vector<std::uint8_t> rgba(row_bytes * std::size_t(part.height_px));
    // Whole squares of footprints if possible, so that few are projected twice.
    const int most =
        std::max(feet_square_px, feet_at_once / part.width_px / feet_square_px * feet_square_px);
    for (int down = 0, rows = 0; down < part.height_px; down += rows) {
        const int into_square = (part.top_px + down) % feet_square_px;
        rows = std::min(most - into_square, part.height_px - down);
        const PicturePart some{part.left_px, part.top_px + down, part.width_px, rows};
        RowPainting painting{*raster_,
                             level_,
                             some,
                             transform_.feet(some),
                             rgba.data() + std::size_t(down) * row_bytes};
        painting.paint(some);
    }
    return rgba;
}

} // namespace macadam
