#include "render/background/coverage_mask.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace macadam {
namespace {

constexpr double whole = 65536; // a covered pixel

/// Integral of clamp(t, 0, 1) from 0 to t.
double ramp_integral(double t) {
    return t <= 0 ? 0 : t < 1 ? t * t / 2 : t - 0.5;
}

/// Mean share of the pixel at `x` that lies to the right of a straight edge from `low` to `high`.
double mean_share(double x, double low, double high) {
    constexpr double steep = 1e-6;
    const double from = x + 1 - low;
    const double to = x + 1 - high;
    return high - low < steep ? std::clamp((from + to) / 2, 0.0, 1.0)
                              : (ramp_integral(from) - ramp_integral(to)) / (high - low);
}

std::uint8_t blended(std::uint8_t under, std::uint32_t over, std::uint32_t share) {
    constexpr unsigned shift = 16;
    constexpr std::uint32_t half = 1U << (shift - 1);
    const auto rest = static_cast<std::uint32_t>(whole) - share;
    return static_cast<std::uint8_t>((under * rest + over * share + half) >> shift);
}

} // namespace

CoverageMask::CoverageMask(const PicturePart& part)
    : part_{part}, change_(std::size_t(part.width_px) * std::size_t(part.height_px)),
      rows_(std::size_t(part.height_px)) {}

void CoverageMask::add(std::span<const PixelPoint> ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        add_edge(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
    }
}

void CoverageMask::add_edge(const PixelPoint& a, const PixelPoint& b) {
    const auto& upper = a.y < b.y ? a : b;
    const auto& lower = a.y < b.y ? b : a;
    const double top = part_.top_px;
    const double bottom = top + part_.height_px;
    if (upper.y == lower.y || lower.y <= top || upper.y >= bottom ||
        std::min(a.x, b.x) >= part_.left_px + part_.width_px) {
        return;
    }
    const double slope = (lower.x - upper.x) / (lower.y - upper.y);
    const auto x_at = [&](double y) { return upper.x + (y - upper.y) * slope; };
    const double last = std::min(std::ceil(lower.y), bottom);
    for (double row = std::max(std::floor(upper.y), top); row < last; ++row) {
        const double from = std::max(row, upper.y);
        const double to = std::min(row + 1, lower.y);
        add_in_row(std::size_t(row - top), x_at(from), x_at(to), to - from, a.y < b.y ? 1 : -1);
    }
}

/// Adds the area to the right of an edge within a row.
void CoverageMask::add_in_row(
    std::size_t row, double from_x, double to_x, double height, int sign) {
    const double low = std::min(from_x, to_x);
    const double high = std::max(from_x, to_x);
    const double left = part_.left_px;
    const double right = left + part_.width_px;
    if (low >= right) {
        return;
    }
    rows_[row] = true;
    auto* const changes = change_.data() + row * std::size_t(part_.width_px);
    const double scale = height * whole;
    // The area up to a pixel is rounded, not that of each: where a part begins makes no difference.
    std::int64_t before = 0;
    const double first = std::max(std::floor(low), left);
    for (double x = first; x < right; ++x) {
        const bool is_all = x >= high;
        const auto now = std::llround(is_all ? scale : scale * mean_share(x, low, high));
        changes[std::size_t(x - left)] += static_cast<std::uint32_t>(sign * (now - before));
        before = now;
        if (is_all) {
            break;
        }
    }
}

void CoverageMask::paint(std::span<std::uint8_t> rgba, std::uint32_t rgb) {
    const auto width = std::size_t(part_.width_px);
    assert(rgba.size() == width * std::size_t(part_.height_px) * 4);
    const std::uint32_t red = rgb >> 16U & 255U;
    const std::uint32_t green = rgb >> 8U & 255U;
    const std::uint32_t blue = rgb & 255U;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        if (!rows_[row]) {
            continue;
        }
        rows_[row] = false;
        auto* const changes = change_.data() + row * width;
        auto* pixel = rgba.data() + row * width * 4;
        std::uint32_t sum = 0;
        for (std::size_t x = 0; x < width; ++x, pixel += 4) {
            sum += changes[x];
            const auto area = std::abs(std::int64_t{static_cast<std::int32_t>(sum)});
            if (area == 0) {
                continue;
            }
            const auto share =
                static_cast<std::uint32_t>(std::min(area, static_cast<std::int64_t>(whole)));
            pixel[0] = blended(pixel[0], red, share);
            pixel[1] = blended(pixel[1], green, share);
            pixel[2] = blended(pixel[2], blue, share);
        }
        std::fill_n(changes, width, 0U);
    }
}

} // namespace macadam
