#include "storage/late/geotiff.hpp"

#include "estimator/common/error.hpp"
#include "storage/late/gdal_errors.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/core.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <fstream>
#include <span>

namespace macadam {

namespace {

[[noreturn]] void fail() {
    throw InputError{fmt::format("cannot be written: {}; the disk may be full",
                                 gdal_said("GDAL does not say why"))};
}

GDALDriver& driver(const char* name) {
    auto* const found = GetGDALDriverManager()->GetDriverByName(name);
    if (found == nullptr) {
        throw InputError{fmt::format("cannot be written: this GDAL knows no {}", name)};
    }
    return *found;
}

/// The picture's own bytes as a dataset.
GDALDatasetUniquePtr dataset_of(const PlacedPicture& picture) {
    GDALDatasetUniquePtr dataset{
        driver("MEM").Create("", picture.width_px, picture.height_px, 0, GDT_Byte, nullptr)};
    if (!dataset) {
        fail();
    }
    constexpr int bands = 3;
    for (int band = 0; band < bands; ++band) {
        std::array<char, 64> pointer{};
        // GDAL takes no pointer to const; the driver that copies from it only reads.
        auto* const bytes = const_cast<std::uint8_t*>(picture.rgb.data()) + band; // NOLINT(*-cast)
        CPLPrintPointer(pointer.data(), bytes, int(pointer.size()) - 1);
        CPLStringList options;
        options.SetNameValue("DATAPOINTER", pointer.data());
        options.SetNameValue("PIXELOFFSET", "3");
        options.SetNameValue("LINEOFFSET",
                             std::to_string(std::int64_t{3} * picture.width_px).c_str());
        if (dataset->AddBand(GDT_Byte, options.List()) != CE_None) {
            fail();
        }
        dataset->GetRasterBand(band + 1)->SetColorInterpretation(
            static_cast<GDALColorInterp>(GCI_RedBand + band));
    }
    return dataset;
}

void place(GDALDataset& dataset, const PlacedPicture& picture) {
    OGRSpatialReference system;
    if (system.importFromWkt(picture.wkt.c_str()) != OGRERR_NONE) {
        fail();
    }
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    dataset.SetSpatialRef(&system);
    std::array<double, 6> transform{
        picture.left, picture.per_px, 0, picture.top, 0, -picture.per_px};
    dataset.SetGeoTransform(transform.data());
    dataset.SetMetadataItem("TIFFTAG_COPYRIGHT", picture.copyright.c_str());
    dataset.SetMetadataItem("TIFFTAG_SOFTWARE", "macadam");
}

/// A file that GDAL keeps in memory. The driver comes to no good end where a disk is full (GDAL 3.6
/// crashes while it makes overviews), so that it never meets one.
class FileInMemory {
public:
    FileInMemory() = default;
    FileInMemory(const FileInMemory&) = delete;
    FileInMemory& operator=(const FileInMemory&) = delete;
    ~FileInMemory() { VSIUnlink(name()); }

    static const char* name() { return "/vsimem/macadam/picture.tif"; }

    std::span<const char> bytes() const {
        vsi_l_offset count = 0;
        const auto* const data = VSIGetMemFileBuffer(name(), &count, FALSE);
        return {reinterpret_cast<const char*>(data), count};
    }
};

void write(const PlacedPicture& picture, const std::filesystem::path& file) {
    const Quiet quiet;
    GDALAllRegister();
    auto source = dataset_of(picture);
    place(*source, picture);
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("OVERVIEW_RESAMPLING", "AVERAGE");
    CPLErrorReset();
    const FileInMemory made;
    GDALDatasetUniquePtr copy{driver("COG").CreateCopy(
        made.name(), source.get(), FALSE, options.List(), nullptr, nullptr)};
    if (!copy) {
        fail();
    }
    copy.reset();
    if (CPLGetLastErrorType() == CE_Failure) {
        fail();
    }
    const auto bytes = made.bytes();
    std::ofstream out{file, std::ios::binary};
    out.write(bytes.data(), std::ssize(bytes));
    out.close();
    if (!out) {
        throw InputError{"cannot be written; the disk may be full"};
    }
}

} // namespace

} // namespace macadam

extern "C" void macadam_geotiff_write(const macadam::PlacedPicture& picture,
                                      const std::filesystem::path& file) {
    macadam::write(picture, file);
}
