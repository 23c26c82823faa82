#include "render/labels/label_occupancy.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr std::uint8_t minor = 1;
constexpr std::uint8_t major = 2;
constexpr std::uint8_t measured = 3;
constexpr int first_minor_rank = 3; // tertiary roads
constexpr double minor_weight = 0.35;

} // namespace

OccupancyGrid::OccupancyGrid(const PixelBox& cell,
                             std::span<const NamedPart> parts,
                             double square_px)
    : square_px_{square_px}, columns_{int(std::ceil(cell.width() / square_px))},
      rows_{int(std::ceil(cell.height() / square_px))},
      road_(std::size_t(columns_) * std::size_t(rows_)) {
    for (const auto& part : parts) {
        mark(part);
    }
}

void OccupancyGrid::mark(const NamedPart& part) {
    const double reach = part.half_width_px / square_px_;
    const auto mark = !part.quiet ? measured : part.rank >= first_minor_rank ? minor : major;
    const auto mark_around = [&](double x, double y) {
        const int left = std::max(0, int(std::floor(x - reach)));
        const int right = std::min(columns_ - 1, int(std::floor(x + reach)));
        const int bottom = std::min(rows_ - 1, int(std::floor(y + reach)));
        for (int row = std::max(0, int(std::floor(y - reach))); row <= bottom; ++row) {
            for (int column = left; column <= right; ++column) {
                auto& road = road_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
                road = std::max(road, mark);
            }
        }
    };
    for (std::size_t i = 0; i + 1 < part.line.size(); ++i) {
        const auto& a = part.line[i];
        const auto& b = part.line[i + 1];
        const double x = b.x - a.x;
        const double y = b.y - a.y;
        const int steps = 1 + int(std::sqrt(x * x + y * y) / square_px_);
        for (int step = 0; step <= steps; ++step) {
            const double t = double(step) / steps;
            mark_around((a.x + t * x) / square_px_, (a.y + t * y) / square_px_);
        }
    }
}

std::uint8_t OccupancyGrid::road_at(const PixelPoint& at) const {
    const int column = int(std::floor(at.x / square_px_));
    const int row = int(std::floor(at.y / square_px_));
    if (column < 0 || column >= columns_ || row < 0 || row >= rows_) {
        return 0;
    }
    return road_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
}

double OccupancyGrid::weight(const PixelPoint& at) const {
    const auto road = road_at(at);
    return road >= major ? 1 : road == minor ? minor_weight : 0;
}

bool OccupancyGrid::is_measured(const PixelPoint& at) const {
    return road_at(at) == measured;
}

} // namespace macadam
