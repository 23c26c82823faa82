#include "storage/rasters/raster_transform.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/gdal_errors.hpp"

#include <fmt/core.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>

namespace macadam {
namespace {

constexpr int square_px = feet_square_px;
constexpr int half_square_px = square_px / 2;
constexpr double straight_px = 0.05; // of the picture: not visible
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

/// Position on the picture or the raster, in pixels.
struct PixelPosition {
    double x, y;
};

bool is_somewhere(const PixelPosition& place) {
    return std::isfinite(place.x) && std::isfinite(place.y);
}

OGRSpatialReference system_of(const std::string& wkt) {
    OGRSpatialReference system;
    const auto done = wkt.empty() ? system.importFromEPSG(3857) : system.importFromWkt(wkt.c_str());
    if (done != OGRERR_NONE) {
        throw InputError{fmt::format("the map's projection is not known to GDAL: {}",
                                     gdal_error("unknown GDAL error"))};
    }
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return system;
}

/// Growth of x per revolution around the globe; 0 if the projection does not wrap in a straight
/// line.
double turn_of(const OGRSpatialReference& system) {
    if (system.IsGeographic() != 0) {
        return 2 * std::numbers::pi / system.GetAngularUnits();
    }
    const char* const code = system.GetAuthorityCode(nullptr);
    constexpr double earth_radius_m = 6378137;
    return code != nullptr && std::string{code} == "3857" ? 2 * std::numbers::pi * earth_radius_m
                                                          : 0;
}

double without_turns(double x, double turn) {
    return turn > 0 ? x - turn * std::floor(x / turn + 0.5) : x;
}

PixelPosition middle_of(const PixelPosition& a, const PixelPosition& b) {
    return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

/// Displacement on the raster for one pixel to the right or down on the picture.
struct PixelStep {
    double x, y;
    double length() const { return std::hypot(x, y); }
};

PixelStep between(const PixelPosition& from, const PixelPosition& to, double px) {
    return {(to.x - from.x) / px, (to.y - from.y) / px};
}

/// Selects the shorter of two steps, because a neighbour may be on the far side of a seam.
PixelStep shorter(const PixelStep& a, const PixelStep& b) {
    return a.length() <= b.length() || !std::isfinite(b.length()) ? a : b;
}

/// Footprint of a pixel; only its position if its neighbours are undefined.
PixelFootprint foot(const PixelPosition& at, const PixelStep& right, const PixelStep& down) {
    const auto reach_px = [](double a, double b) {
        const double px = std::hypot(a, b);
        return std::isfinite(px) ? float(px) : 0.F;
    };
    return {at.x, at.y, reach_px(right.x, down.x), reach_px(right.y, down.y)};
}

/// Positions of a square of the picture: its corners, the midpoints of its sides, and its centre,
/// row by row.
using SquarePositions = std::array<PixelPosition, 9>;

bool are_straight(const SquarePositions& at) {
    const auto right = between(at[0], at[2], square_px);
    const auto down = between(at[0], at[6], square_px);
    const double tolerated_px = straight_px * std::max(right.length(), down.length());
    const auto is_near = [&](const PixelPosition& a, const PixelPosition& b) {
        return between(a, b, 1).length() <= tolerated_px; // false if a position is undefined
    };
    return is_near(at[1], middle_of(at[0], at[2])) && is_near(at[3], middle_of(at[0], at[6])) &&
           is_near(at[5], middle_of(at[2], at[8])) && is_near(at[7], middle_of(at[6], at[8])) &&
           is_near(at[4], middle_of(middle_of(at[0], at[2]), middle_of(at[6], at[8])));
}

PixelPosition mixed(const PixelPosition& a, const PixelPosition& b, double share) {
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

std::vector<PixelPosition> grid_over(int width_px, int height_px) {
    constexpr int steps = 32;
    std::vector<PixelPosition> places;
    for (int row = 0; row <= steps; ++row) {
        for (int column = 0; column <= steps; ++column) {
            places.push_back({double(width_px) * column / steps, double(height_px) * row / steps});
        }
    }
    return places;
}

/// Footprints of the pixels of a square, row by row.
using SquareFeet = std::array<PixelFootprint, std::size_t{square_px} * square_px>;

SquareFeet bilinear(const SquarePositions& at) {
    const auto right = between(middle_of(at[0], at[6]), middle_of(at[2], at[8]), square_px);
    const auto down = between(middle_of(at[0], at[2]), middle_of(at[6], at[8]), square_px);
    SquareFeet feet{};
    feet.fill(foot(at[4], right, down));
    for (int row = 0; row < square_px; ++row) {
        const double along = (row + 0.5) / square_px;
        const auto from = mixed(at[0], at[6], along);
        const auto to = mixed(at[2], at[8], along);
        for (int column = 0; column < square_px; ++column) {
            const auto place = mixed(from, to, (column + 0.5) / square_px);
            auto& here = feet[std::size_t(row) * square_px + std::size_t(column)];
            here.x = place.x;
            here.y = place.y;
        }
    }
    return feet;
}

/// Copies the overlap of `part` and the square at `left_px`, `top_px` into the footprints of
/// `part`.
void copy_shared(const SquareFeet& square,
                 int left_px,
                 int top_px,
                 const PicturePart& part,
                 std::vector<PixelFootprint>& feet) {
    const int left = std::max(part.left_px, left_px);
    const int right = std::min(part.left_px + part.width_px, left_px + square_px);
    const int bottom = std::min(part.top_px + part.height_px, top_px + square_px);
    for (int y = std::max(part.top_px, top_px); y < bottom; ++y) {
        const auto* from =
            square.data() + std::size_t(y - top_px) * square_px + std::size_t(left - left_px);
        auto* to = feet.data() + std::size_t(y - part.top_px) * std::size_t(part.width_px) +
                   std::size_t(left - part.left_px);
        std::copy_n(from, right - left, to);
    }
}

} // namespace

struct RasterTransform::Impl {
    using Way = std::unique_ptr<OGRCoordinateTransformation>;

    std::vector<PixelPosition> on_raster(std::vector<PixelPosition> of_picture) const;
    std::vector<PixelPosition> on_picture(std::vector<PixelPosition> of_raster) const;
    PixelPosition pixel_at(double x, double y) const;
    bool is_inside(const PixelPosition& place) const;
    bool is_shown(const PixelPosition& place) const;
    SquareFeet each_projected(int left_px, int top_px) const;
    std::vector<PixelPosition> sample() const;

    PicturePlane plane;
    int width_px, height_px;
    std::array<double, 6> forward, backward; ///< geotransforms of the raster
    double plane_turn, raster_turn;
    Way to_raster, to_plane;
};

bool RasterTransform::Impl::is_inside(const PixelPosition& place) const {
    return place.x >= 0 && place.x <= width_px && place.y >= 0 && place.y <= height_px;
}

bool RasterTransform::Impl::is_shown(const PixelPosition& place) const {
    return place.x >= 0 && place.x <= plane.width_px && place.y >= 0 && place.y <= plane.height_px;
}

/// Finds the pixel in any revolution: the raster may span 0 to 360 degrees or the antimeridian.
PixelPosition RasterTransform::Impl::pixel_at(double x, double y) const {
    const auto with_turns = [&](int turns) {
        const double there = x + turns * raster_turn;
        return PixelPosition{backward[0] + there * backward[1] + y * backward[2],
                             backward[3] + there * backward[4] + y * backward[5]};
    };
    const auto here = with_turns(0);
    if (raster_turn > 0 && is_somewhere(here) && !is_inside(here)) {
        for (const int turns : {1, -1}) {
            if (const auto there = with_turns(turns); is_inside(there)) {
                return there;
            }
        }
    }
    return here;
}

/// Transforms positions to the raster. A position that does not transform back to itself is not on
/// the plane: it is beyond the horizon, or in a fold.
std::vector<PixelPosition>
RasterTransform::Impl::on_raster(std::vector<PixelPosition> of_picture) const {
    const auto count = of_picture.size();
    std::vector<double> x(count);
    std::vector<double> y(count);
    for (std::size_t i = 0; i < count; ++i) {
        x[i] = without_turns(plane.left + of_picture[i].x * plane.per_px, plane_turn);
        y[i] = plane.top - of_picture[i].y * plane.per_px;
    }
    auto there_x = x;
    auto there_y = y;
    std::vector<int> is_known(count);
    to_raster->Transform(int(count), there_x.data(), there_y.data(), nullptr, is_known.data());
    auto back_x = there_x;
    auto back_y = there_y;
    std::vector<int> is_back(count);
    to_plane->Transform(int(count), back_x.data(), back_y.data(), nullptr, is_back.data());
    for (std::size_t i = 0; i < count; ++i) {
        const double off_x = without_turns(back_x[i] - x[i], plane_turn);
        const bool is_there = is_known[i] != FALSE && is_back[i] != FALSE &&
                              std::hypot(off_x, back_y[i] - y[i]) < plane.per_px;
        of_picture[i] =
            is_there ? pixel_at(there_x[i], there_y[i]) : PixelPosition{nowhere, nowhere};
    }
    return of_picture;
}

std::vector<PixelPosition>
RasterTransform::Impl::on_picture(std::vector<PixelPosition> of_raster) const {
    const double middle_x = plane.left + plane.width_px * plane.per_px / 2;
    for (auto& place : of_raster) {
        double x = forward[0] + place.x * forward[1] + place.y * forward[2];
        double y = forward[3] + place.x * forward[4] + place.y * forward[5];
        int is_known = FALSE;
        to_plane->Transform(1, &x, &y, nullptr, &is_known);
        x = middle_x + without_turns(x - middle_x, plane_turn);
        place = is_known != FALSE
                    ? PixelPosition{(x - plane.left) / plane.per_px, (plane.top - y) / plane.per_px}
                    : PixelPosition{nowhere, nowhere};
    }
    return of_raster;
}

/// Projects each pixel of a square, without the corner check.
SquareFeet RasterTransform::Impl::each_projected(int left_px, int top_px) const {
    constexpr int side = square_px + 2; // with neighbours on all sides
    std::vector<PixelPosition> places;
    places.reserve(std::size_t{side} * side);
    for (int row = -1; row <= square_px; ++row) {
        for (int column = -1; column <= square_px; ++column) {
            places.push_back({left_px + column + 0.5, top_px + row + 0.5});
        }
    }
    places = on_raster(std::move(places));
    SquareFeet feet{};
    for (int i = 0; i < square_px * square_px; ++i) {
        const auto* const at =
            places.data() + std::ptrdiff_t{i / square_px + 1} * side + i % square_px + 1;
        const auto right = shorter(between(at[0], at[1], 1), between(at[-1], at[0], 1));
        const auto down = shorter(between(at[0], at[side], 1), between(at[-side], at[0], 1));
        feet[std::size_t(i)] = foot(at[0], right, down);
    }
    return feet;
}

RasterTransform::RasterTransform(const PicturePlane& plane, const RasterFile& raster) {
    const GdalErrorScope quiet;
    const auto system = system_of(plane.wkt);
    Impl::Way to_raster{OGRCreateCoordinateTransformation(&system, &raster.system())};
    Impl::Way to_plane{OGRCreateCoordinateTransformation(&raster.system(), &system)};
    if (!to_raster || !to_plane) {
        throw InputError{fmt::format("{}: PROJ has no transformation to it from the map's "
                                     "projection: {}",
                                     raster.name(),
                                     gdal_error("unknown error"))};
    }
    impl_ = std::make_unique<Impl>(Impl{.plane = plane,
                                        .width_px = raster.width_px(),
                                        .height_px = raster.height_px(),
                                        .forward = raster.forward(),
                                        .backward = raster.backward(),
                                        .plane_turn = turn_of(system),
                                        .raster_turn = turn_of(raster.system()),
                                        .to_raster = std::move(to_raster),
                                        .to_plane = std::move(to_plane)});
}

RasterTransform::~RasterTransform() = default;

std::vector<PixelFootprint> RasterTransform::feet(const PicturePart& part) const {
    const GdalErrorScope quiet;
    const int first_column = part.left_px / square_px;
    const int first_row = part.top_px / square_px;
    const int columns = (part.left_px + part.width_px - 1) / square_px - first_column + 1;
    const int rows = (part.top_px + part.height_px - 1) / square_px - first_row + 1;
    const auto across = std::size_t(2 * columns + 1);
    std::vector<PixelPosition> places;
    places.reserve(across * std::size_t(2 * rows + 1));
    for (int row = 0; row <= 2 * rows; ++row) {
        for (int column = 0; column <= 2 * columns; ++column) {
            places.push_back({double(first_column * square_px + column * half_square_px),
                              double(first_row * square_px + row * half_square_px)});
        }
    }
    places = impl_->on_raster(std::move(places));

    std::vector<PixelFootprint> feet(std::size_t(part.width_px) * std::size_t(part.height_px),
                                     {nowhere, nowhere, 0, 0});
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            SquarePositions at{};
            for (std::size_t i = 0; i < at.size(); ++i) {
                at[i] = places[(std::size_t(row) * 2 + i / 3) * across + std::size_t(column) * 2 +
                               i % 3];
            }
            const int left = (first_column + column) * square_px;
            const int top = (first_row + row) * square_px;
            if (are_straight(at)) {
                copy_shared(bilinear(at), left, top, part, feet);
            } else if (std::ranges::any_of(at, is_somewhere)) {
                copy_shared(impl_->each_projected(left, top), left, top, part, feet);
            }
        }
    }
    return feet;
}

/// Sample positions on the picture, spread over it and over its overlap with the raster.
std::vector<PixelPosition> RasterTransform::Impl::sample() const {
    auto places = on_picture(grid_over(width_px, height_px));
    std::erase_if(places, [&](const PixelPosition& place) { return !is_shown(place); });
    std::ranges::copy(grid_over(plane.width_px, plane.height_px), std::back_inserter(places));
    return places;
}

std::optional<double> RasterTransform::min_foot_px() const {
    const GdalErrorScope quiet;
    const auto places = impl_->sample();
    std::vector<PixelPosition> with_neighbours;
    for (const auto& place : places) {
        with_neighbours.push_back(place);
        with_neighbours.push_back({place.x + 1, place.y});
        with_neighbours.push_back({place.x, place.y + 1});
    }
    with_neighbours = impl_->on_raster(std::move(with_neighbours));
    std::optional<double> least;
    for (std::size_t i = 0; i < with_neighbours.size(); i += 3) {
        const auto* const at = with_neighbours.data() + i;
        const auto size = foot(at[0], between(at[0], at[1], 1), between(at[0], at[2], 1));
        const double side = std::sqrt(double(size.width_px) * double(size.height_px));
        if (impl_->is_inside(at[0]) && side > 0) {
            least = std::min(least.value_or(side), side);
        }
    }
    return least;
}

} // namespace macadam
