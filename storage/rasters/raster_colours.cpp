#include "storage/rasters/raster_colours.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace macadam {
namespace {

constexpr int colours_of_a_byte = 256;

std::optional<double> no_data_of(GDALRasterBand& band) {
    int is_there = FALSE;
    const double value = band.GetNoDataValue(&is_there);
    return is_there != FALSE ? std::optional{value} : std::nullopt;
}

/// Maximum value of a band, which may have fewer bits than a byte, such as black and white scans.
int most_of(GDALRasterBand& band) {
    const char* const bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
    const int count = bits != nullptr ? std::atoi(bits) : 8; // NOLINT(cert-err34-c): GDAL wrote it
    return (1 << std::clamp(count, 1, 8)) - 1;
}

std::vector<Rgba> grey_table(GDALRasterBand& band) {
    const int most = most_of(band);
    std::vector<Rgba> table;
    for (int i = 0; i < colours_of_a_byte; ++i) {
        const auto grey = std::uint8_t(std::lround(255.0 * std::min(i, most) / most));
        table.push_back({grey, grey, grey, 255});
    }
    return table;
}

std::vector<Rgba> palette_table(const GDALColorTable& colours) {
    const auto byte = [](short value) { return std::uint8_t(std::clamp<int>(value, 0, 255)); };
    std::vector<Rgba> table(colours_of_a_byte); // values without an entry are transparent
    for (int i = 0; i < std::min(colours_of_a_byte, colours.GetColorEntryCount()); ++i) {
        GDALColorEntry entry{};
        colours.GetColorEntryAsRGB(i, &entry);
        table[std::size_t(i)] = {byte(entry.c1), byte(entry.c2), byte(entry.c3), byte(entry.c4)};
    }
    return table;
}

std::vector<Rgba> table_of(GDALRasterBand& band) {
    const auto* const colours = band.GetColorTable();
    auto table = colours != nullptr ? palette_table(*colours) : grey_table(band);
    const auto none = no_data_of(band);
    if (none && *none >= 0 && *none < colours_of_a_byte && *none == std::floor(*none)) {
        table[std::size_t(*none)] = {};
    }
    return table;
}

/// Number of the band with a given meaning; 0 if there is none.
int band_of(GDALDataset& raster, GDALColorInterp meaning) {
    for (int number = 1; number <= raster.GetRasterCount(); ++number) {
        if (raster.GetRasterBand(number)->GetColorInterpretation() == meaning) {
            return number;
        }
    }
    return 0;
}

std::vector<int> bands_of(GDALDataset& raster, const std::string& file) {
    const int red = band_of(raster, GCI_RedBand);
    const int green = band_of(raster, GCI_GreenBand);
    const int blue = band_of(raster, GCI_BlueBand);
    if (red != 0 && green != 0 && blue != 0) {
        return {red, green, blue};
    }
    const auto first = raster.GetRasterBand(1)->GetColorInterpretation();
    if (first == GCI_CyanBand || first == GCI_HueBand || first == GCI_YCbCr_YBand) {
        throw InputError{fmt::format("{}: its first band is {}, expected grey, a palette, or "
                                     "red, green and blue; convert it with gdalwarp or an "
                                     "image editor",
                                     file,
                                     GDALGetColorInterpretationName(first))};
    }
    const int without_alpha =
        raster.GetRasterCount() - (band_of(raster, GCI_AlphaBand) != 0 ? 1 : 0);
    if (without_alpha == 3 || without_alpha == 4) { // four: with near infrared, as in aerial images
        return {1, 2, 3};
    }
    if (without_alpha == 1) {
        return {1};
    }
    throw InputError{fmt::format("{}: has {} bands without colour interpretation, expected "
                                 "grey, a palette, or red, green and blue; gdal_translate -b "
                                 "selects bands",
                                 file,
                                 raster.GetRasterCount())};
}

void expect_bytes(GDALDataset& raster, const std::vector<int>& bands, const std::string& file) {
    for (const int number : bands) {
        const auto type = raster.GetRasterBand(number)->GetRasterDataType();
        if (type != GDT_Byte) {
            throw InputError{
                fmt::format("{}: contains numbers of type {}, expected 8-bit colours; convert "
                            "it with gdal_translate -ot Byte -scale",
                            file,
                            GDALGetDataTypeName(type))};
        }
    }
}

} // namespace

RasterColours colours_of(GDALDataset& raster, const std::string& file) {
    RasterColours colours;
    colours.bands = bands_of(raster, file);
    colours.alpha_band = band_of(raster, GCI_AlphaBand);
    auto numbers = colours.bands;
    if (colours.alpha_band != 0) {
        numbers.push_back(colours.alpha_band);
    }
    expect_bytes(raster, numbers, file);
    auto& first = *raster.GetRasterBand(colours.bands[0]);
    if (colours.bands.size() == 1) {
        colours.table = table_of(first);
    } else {
        for (std::size_t i = 0; i < 3; ++i) {
            colours.no_data[i] = no_data_of(*raster.GetRasterBand(colours.bands[i]));
        }
    }
    const int flags = first.GetMaskFlags();
    colours.masked = colours.alpha_band == 0 && (flags & GMF_ALL_VALID) == 0 && flags != GMF_NODATA;
    return colours;
}

} // namespace macadam
