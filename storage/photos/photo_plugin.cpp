#include "storage/photos/photo_plugin.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/gdal_access.hpp"
#include "storage/gdal/gdal_errors.hpp"
#include "storage/gdal/map_kind.hpp"
#include "storage/photos/exif.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/core.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int bands = 3;

/// Setting of GDAL in this thread for the lifetime of this value.
class GdalSetting {
public:
    GdalSetting(const char* name, const char* value) : name_{name} {
        CPLSetThreadLocalConfigOption(name_, value);
    }
    GdalSetting(const GdalSetting&) = delete;
    GdalSetting& operator=(const GdalSetting&) = delete;
    ~GdalSetting() { CPLSetThreadLocalConfigOption(name_, nullptr); }

private:
    const char* name_;
};

/// Pixels of red, green and blue, top row first.
struct Pixels {
    int width_px, height_px;
    std::vector<std::uint8_t> rgb;
};

void expect_jpeg(const fs::path& file) {
    std::error_code none;
    if (!fs::is_regular_file(fs::symlink_status(file, none))) {
        throw InputError{fmt::format("{}: is not a regular file, expected a JPEG", file.string())};
    }
    if (kind_of_map(file) != MapKind::jpeg) {
        throw InputError{fmt::format("{}: is not a JPEG", file.string())};
    }
}

/// Returns the beginning of a file, in which EXIF data lie.
std::string head_of(const fs::path& file) {
    constexpr std::size_t max_bytes = 1 << 18; // a block of EXIF data has at most 64 KiB
    std::string head(max_bytes, '\0');
    std::ifstream in{file, std::ios::binary};
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    return head;
}

void read_place(const fs::path& file, PhotoPlace& place) {
    expect_jpeg(file);
    const auto exif = read_exif(head_of(file));
    if (!exif.at) {
        throw InputError{fmt::format(
            "{}: tells no position, expected a photo with GPS in its EXIF data", file.string())};
    }
    place = {*exif.at, exif.day};
}

[[noreturn]] void fail(const fs::path& file) {
    throw InputError{
        fmt::format("{}: is damaged: {}", file.string(), gdal_error("not a readable JPEG"))};
}

/// Reads a photo at the size at which neither side exceeds a limit.
Pixels read_reduced(const fs::path& file, int max_px) {
    const auto dataset = open_raster(file).dataset;
    const int width_px = dataset->GetRasterXSize();
    const int height_px = dataset->GetRasterYSize();
    if (std::int64_t{width_px} * height_px > max_photo_px) {
        throw InputError{fmt::format("{}: has {} × {} pixels, expected at most {} million",
                                     file.string(),
                                     width_px,
                                     height_px,
                                     max_photo_px / 1'000'000)};
    }
    if (const int found = dataset->GetRasterCount(); found != 1 && found != bands) {
        throw InputError{
            fmt::format("{}: has {} channels, expected grey or colour", file.string(), found)};
    }
    const double scale = std::min(1.0, double(max_px) / std::max(width_px, height_px));
    Pixels pixels{std::max(1, int(std::lround(width_px * scale))),
                  std::max(1, int(std::lround(height_px * scale))),
                  {}};
    pixels.rgb.resize(std::size_t(pixels.width_px) * std::size_t(pixels.height_px) * bands);
    GDALRasterIOExtraArg extra;
    INIT_RASTERIO_EXTRA_ARG(extra);
    extra.eResampleAlg = GRIORA_Average;
    std::array<int, bands> from{1, 2, 3};
    if (dataset->GetRasterCount() == 1) {
        from.fill(1);
    }
    if (dataset->RasterIO(GF_Read,
                          0,
                          0,
                          width_px,
                          height_px,
                          pixels.rgb.data(),
                          pixels.width_px,
                          pixels.height_px,
                          GDT_Byte,
                          bands,
                          from.data(),
                          bands,
                          GSpacing{bands} * pixels.width_px,
                          1,
                          &extra) != CE_None) {
        fail(file);
    }
    return pixels;
}

/// Turns and mirrors a picture as the orientation of EXIF asks for.
Pixels upright(const Pixels& of, int orientation) {
    const bool transposed = orientation >= 5;
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 ||
                            orientation == 8; // columns of the stored picture
    const bool from_bottom =
        orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7; // its rows
    Pixels turned{transposed ? of.height_px : of.width_px,
                  transposed ? of.width_px : of.height_px,
                  std::vector<std::uint8_t>(of.rgb.size())};
    auto to = turned.rgb.begin();
    for (int y = 0; y < turned.height_px; ++y) {
        for (int x = 0; x < turned.width_px; ++x) {
            const int column = transposed ? y : x;
            const int row = transposed ? x : y;
            const auto from_x = std::size_t(from_right ? of.width_px - 1 - column : column);
            const auto from_y = std::size_t(from_bottom ? of.height_px - 1 - row : row);
            const auto from =
                of.rgb.begin() +
                static_cast<std::ptrdiff_t>((from_y * std::size_t(of.width_px) + from_x) * bands);
            to = std::copy(from, from + bands, to);
        }
    }
    return turned;
}

std::vector<std::uint8_t> jpeg_of(Pixels pixels, const fs::path& file) {
    constexpr const char* name = "/vsimem/macadam/photo.jpg";
    const GDALDatasetUniquePtr picture{driver_in_memory("MEM").Create(
        "", pixels.width_px, pixels.height_px, bands, GDT_Byte, nullptr)};
    if (!picture || picture->RasterIO(GF_Write,
                                      0,
                                      0,
                                      pixels.width_px,
                                      pixels.height_px,
                                      pixels.rgb.data(),
                                      pixels.width_px,
                                      pixels.height_px,
                                      GDT_Byte,
                                      bands,
                                      nullptr,
                                      bands,
                                      GSpacing{bands} * pixels.width_px,
                                      1,
                                      nullptr) != CE_None) {
        fail(file);
    }
    CPLStringList options;
    options.SetNameValue("QUALITY", "78");
    options.SetNameValue("WRITE_EXIF_METADATA", "NO");
    const GDALDatasetUniquePtr copy{driver_in_memory("JPEG").CreateCopy(
        name, picture.get(), FALSE, options.List(), nullptr, nullptr)};
    if (!copy) {
        fail(file);
    }
    vsi_l_offset count = 0;
    const auto* const data = VSIGetMemFileBuffer(name, &count, FALSE);
    std::vector<std::uint8_t> bytes{data, data + count};
    VSIUnlink(name);
    return bytes;
}

void reduce(const fs::path& file, int max_px, SmallPhoto& photo) {
    expect_jpeg(file);
    const GdalErrorScope quiet;
    const GdalSetting alone{"GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR"}; // no files beside it
    const GdalSetting no_own_data{"GDAL_PAM_ENABLED", "NO"};
    const GdalSetting whole{"GDAL_ERROR_ON_LIBJPEG_WARNING", "TRUE"};
    const GdalSetting few_scans{"GDAL_JPEG_MAX_ALLOWED_SCAN_NUMBER", "32"}; // usual are 10
    auto pixels = upright(read_reduced(file, max_px), read_exif(head_of(file)).orientation);
    photo.width_px = pixels.width_px;
    photo.height_px = pixels.height_px;
    photo.jpeg = jpeg_of(std::move(pixels), file);
}

} // namespace
} // namespace macadam

extern "C" void macadam_photo_place_read(const std::filesystem::path& file,
                                         macadam::PhotoPlace& place) {
    macadam::read_place(file, place);
}

extern "C" void
macadam_photo_reduce(const std::filesystem::path& file, int max_px, macadam::SmallPhoto& photo) {
    macadam::reduce(file, max_px, photo);
}
