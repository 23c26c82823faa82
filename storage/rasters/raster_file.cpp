#include "storage/rasters/raster_file.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/coordinate_system.hpp"
#include "storage/gdal/gdal_access.hpp"
#include "storage/gdal/gdal_errors.hpp"
#include "storage/rasters/raster_attribution.hpp"
#include "storage/rasters/raster_colours.hpp"

#include <fmt/core.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr double tolerated = 1.05; // of a level's pixels: not visible

/// Geotransforms of GDAL: from pixel and line to x and y, and back.
struct Transforms {
    std::array<double, 6> forward{}, backward{};
};

Transforms transforms_of(GDALDataset& raster, const std::string& file) {
    Transforms transforms;
    if (raster.GetGeoTransform(transforms.forward.data()) != CE_None ||
        GDALInvGeoTransform(transforms.forward.data(), transforms.backward.data()) == FALSE) {
        throw InputError{fmt::format(
            "{}: is not georeferenced, expected a georeferenced raster; add a world file or "
            "use gdal_translate -a_ullr",
            file)};
    }
    return transforms;
}

OGRSpatialReference system_of(GDALDataset& raster, const std::string& file) {
    const auto* const system = raster.GetSpatialRef();
    if (system == nullptr || system->IsEmpty() || system->IsLocal()) {
        throw InputError{
            fmt::format("{}: has no coordinate system, expected a georeferenced raster; assign "
                        "one with gdal_translate -a_srs EPSG:...",
                        file)};
    }
    expect_grids_of_proj(*system, file);
    OGRSpatialReference own{*system};
    own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return own;
}

std::size_t bytes_of(const RasterBox& box) {
    return std::size_t(box.width_px) * std::size_t(box.height_px) * 4;
}

/// Sum of colours weighted by opacity.
struct ColourSum {
    std::array<std::uint64_t, 3> rgb{};
    std::uint64_t alpha = 0;

    void add(const std::uint8_t* rgba) {
        for (std::size_t i = 0; i < 3; ++i) {
            rgb[i] += std::uint64_t{rgba[i]} * rgba[3];
        }
        alpha += rgba[3];
    }

    Rgba mean(std::uint64_t count) const {
        if (alpha == 0) {
            return {};
        }
        const auto colour = [&](std::size_t i) {
            return std::uint8_t((rgb[i] + alpha / 2) / alpha);
        };
        return {colour(0), colour(1), colour(2), std::uint8_t((alpha + count / 2) / count)};
    }
};

/// Evenly spaced pixels of a box; as many as it has: all of them.
struct Samples {
    int across, down;
};

/// Of one side of a square whose mean is taken: a mean of 4096 pixels is no better for more, and
/// the work grows with the picture, not with the size that a file claims.
constexpr int max_samples = 64;

/// Number of samples in part of a square.
int samples_in(int part_px, int side_px) {
    return side_px <= max_samples ? part_px
                                  : std::max(1, int(std::int64_t{part_px} * max_samples / side_px));
}

/// Writes the mean of each square in a row of squares that are `side` samples wide, the last one
/// perhaps narrower.
void put_means(const std::vector<std::uint8_t>& rgba,
               const Samples& samples,
               int side,
               std::uint8_t* means) {
    for (int left = 0; left < samples.across; left += side, means += 4) {
        const int end = std::min(left + side, samples.across);
        ColourSum sum;
        for (int row = 0; row < samples.down; ++row) {
            for (int column = left; column < end; ++column) {
                sum.add(rgba.data() +
                        (std::size_t(row) * std::size_t(samples.across) + std::size_t(column)) * 4);
            }
        }
        std::ranges::copy(sum.mean(std::uint64_t(samples.down) * std::uint64_t(end - left)), means);
    }
}

} // namespace

struct RasterFile::Impl {
    GDALRasterBand& band(int number, int overview) const;
    GDALRasterBand& mask(int overview) const;
    void read(GDALRasterBand& from,
              const RasterBox& box,
              const Samples& samples,
              std::uint8_t* to) const;
    std::vector<std::uint8_t>
    pixels(int overview, const RasterBox& box, const Samples& samples) const;
    std::vector<std::uint8_t> means(const RasterLevel& level, const RasterBox& box) const;
    void colour(std::vector<std::uint8_t>& rgba) const;

    std::string name;
    std::shared_ptr<GDALDataset> raster;
    std::vector<fs::path> files;
    Transforms transforms;
    OGRSpatialReference system;
    RasterColours colours;
};

GDALRasterBand& RasterFile::Impl::band(int number, int overview) const {
    auto* const whole = raster->GetRasterBand(number);
    auto* const found = overview < 0 ? whole : whole->GetOverview(overview);
    if (found == nullptr) {
        throw InputError{fmt::format(
            "{}: band {} lacks an overview that band {} has", name, number, colours.bands[0])};
    }
    return *found;
}

GDALRasterBand& RasterFile::Impl::mask(int overview) const {
    auto* const whole = raster->GetRasterBand(colours.bands[0])->GetMaskBand();
    if (overview >= 0 && overview < whole->GetOverviewCount()) {
        return *whole->GetOverview(overview);
    }
    return *band(colours.bands[0], overview).GetMaskBand();
}

void RasterFile::Impl::read(GDALRasterBand& from,
                            const RasterBox& box,
                            const Samples& samples,
                            std::uint8_t* to) const {
    const auto done = from.RasterIO(GF_Read,
                                    box.left_px,
                                    box.top_px,
                                    box.width_px,
                                    box.height_px,
                                    to,
                                    samples.across,
                                    samples.down,
                                    GDT_Byte,
                                    4,
                                    GSpacing{4} * samples.across,
                                    nullptr);
    if (done != CE_None) {
        throw InputError{
            fmt::format("{}: cannot be read: {}", name, gdal_error("unknown GDAL error"))};
    }
}

/// Converts band values to colours in place.
void RasterFile::Impl::colour(std::vector<std::uint8_t>& rgba) const {
    const auto& none = colours.no_data;
    for (std::size_t at = 0; at < rgba.size(); at += 4) {
        auto* const pixel = rgba.data() + at;
        if (!colours.table.empty()) {
            const auto& entry = colours.table[pixel[0]];
            std::copy_n(entry.begin(), 3, pixel);
            pixel[3] = std::uint8_t((int{pixel[3]} * entry[3] + 127) / 255);
        } else if (none[0] && none[1] && none[2] && pixel[0] == *none[0] && pixel[1] == *none[1] &&
                   pixel[2] == *none[2]) {
            pixel[3] = 0;
        }
    }
}

std::vector<std::uint8_t>
RasterFile::Impl::pixels(int overview, const RasterBox& box, const Samples& samples) const {
    std::vector<std::uint8_t> rgba(std::size_t(samples.across) * std::size_t(samples.down) * 4,
                                   255);
    for (std::size_t i = 0; i < colours.bands.size(); ++i) {
        read(band(colours.bands[i], overview), box, samples, rgba.data() + i);
    }
    if (colours.alpha_band != 0) {
        read(band(colours.alpha_band, overview), box, samples, rgba.data() + 3);
    } else if (colours.masked) {
        read(mask(overview), box, samples, rgba.data() + 3);
    }
    colour(rgba);
    return rgba;
}

/// Averages row by row and a limited number of columns at a time, to save memory for large rasters
/// without overviews.
std::vector<std::uint8_t> RasterFile::Impl::means(const RasterLevel& level,
                                                  const RasterBox& box) const {
    constexpr int pixels_at_once = 1 << 22; // 16 MB
    const int side = level.decimation;
    const int side_samples = samples_in(side, side);
    const int squares_at_once = std::max(1, pixels_at_once / (side_samples * side_samples));
    const auto& first = band(colours.bands[0], level.overview);
    auto& source = const_cast<GDALRasterBand&>(first); // NOLINT(*-const-cast): sizes are not const
    std::vector<std::uint8_t> rgba(bytes_of(box));
    for (int y = 0; y < box.height_px; ++y) {
        const int top = (box.top_px + y) * side;
        const int height = std::min(side, source.GetYSize() - top);
        for (int x = 0; x < box.width_px;) {
            // The last square of the raster, which may be cut off, is read on its own: its samples
            // are spaced otherwise.
            const int left = (box.left_px + x) * side;
            const int squares = std::min({squares_at_once,
                                          box.width_px - x,
                                          std::max(1, (source.GetXSize() - left) / side)});
            const int width =
                int(std::min(std::int64_t{squares} * side, std::int64_t{source.GetXSize()} - left));
            const Samples samples{squares > 1 ? squares * side_samples : samples_in(width, side),
                                  samples_in(height, side)};
            put_means(pixels(level.overview, {left, top, width, height}, samples),
                      samples,
                      side_samples,
                      rgba.data() +
                          (std::size_t(y) * std::size_t(box.width_px) + std::size_t(x)) * 4);
            x += squares;
        }
    }
    return rgba;
}

RasterFile::RasterFile(const fs::path& file) {
    const GdalErrorScope quiet;
    auto [raster, files] = open_raster(file);
    const auto name = file.string();
    const auto transforms = transforms_of(*raster, name);
    auto system = system_of(*raster, name);
    auto colours = colours_of(*raster, name);
    impl_ = std::make_unique<Impl>(Impl{name,
                                        std::move(raster),
                                        std::move(files),
                                        transforms,
                                        std::move(system),
                                        std::move(colours)});
}

RasterFile::~RasterFile() = default;

std::string RasterFile::name() const {
    return impl_->name;
}

int RasterFile::width_px() const {
    return impl_->raster->GetRasterXSize();
}

int RasterFile::height_px() const {
    return impl_->raster->GetRasterYSize();
}

const OGRSpatialReference& RasterFile::system() const {
    return impl_->system;
}

std::array<double, 6> RasterFile::forward() const {
    return impl_->transforms.forward;
}

std::array<double, 6> RasterFile::backward() const {
    return impl_->transforms.backward;
}

std::string RasterFile::attribution() const {
    const GdalErrorScope quiet;
    return attribution_of(*impl_->raster);
}

std::vector<fs::path> RasterFile::files() const {
    return impl_->files;
}

RasterLevel RasterFile::level(double wanted_px) const {
    const GdalErrorScope quiet;
    auto& whole = impl_->band(impl_->colours.bands[0], -1);
    RasterLevel best{.width_px = whole.GetXSize(), .height_px = whole.GetYSize()};
    const auto per_px = [&](int part_px) { return double(whole.GetXSize()) / part_px; };
    for (int i = 0; i < whole.GetOverviewCount(); ++i) {
        auto* const copy = whole.GetOverview(i);
        if (copy != nullptr && copy->GetXSize() < best.width_px &&
            per_px(copy->GetXSize()) <= wanted_px * tolerated) {
            best = {.overview = i, .width_px = copy->GetXSize(), .height_px = copy->GetYSize()};
        }
    }
    const int width = best.width_px;
    const int height = best.height_px;
    while (best.decimation < std::max(width, height) / 2 &&
           per_px(width) * best.decimation * 2 <= wanted_px * tolerated) {
        best.decimation *= 2;
    }
    best.per_px_x = per_px(width) * best.decimation;
    best.per_px_y = double(whole.GetYSize()) / height * best.decimation;
    best.width_px = (width - 1) / best.decimation + 1;
    best.height_px = (height - 1) / best.decimation + 1;
    return best;
}

std::vector<std::uint8_t> RasterFile::rgba(const RasterLevel& level, const RasterBox& box) const {
    const GdalErrorScope quiet;
    return level.decimation == 1 ? impl_->pixels(level.overview, box, {box.width_px, box.height_px})
                                 : impl_->means(level, box);
}

} // namespace macadam
