#include "storage/rasters/geotiff_plugin.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/gdal_access.hpp"
#include "storage/gdal/gdal_errors.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/core.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <utility>

namespace macadam {

namespace {

[[noreturn]] void fail() {
    throw InputError{fmt::format("cannot be written: {}; there may be too little memory",
                                 gdal_error("unknown GDAL error"))};
}

void place(GDALDataset& dataset, const PictureFrame& picture) {
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

/// In-memory file of GDAL. The driver fails badly on a full disk (GDAL 3.6 crashes while it builds
/// overviews), so it never writes to the disk.
class FileInMemory {
public:
    explicit FileInMemory(std::string name) : name_{"/vsimem/macadam/" + std::move(name)} {}
    FileInMemory(const FileInMemory&) = delete;
    FileInMemory& operator=(const FileInMemory&) = delete;
    ~FileInMemory() { VSIUnlink(name()); }

    const char* name() const { return name_.c_str(); }

    std::span<const char> bytes() const {
        vsi_l_offset count = 0;
        const auto* const data = VSIGetMemFileBuffer(name(), &count, FALSE);
        return {reinterpret_cast<const char*>(data), count};
    }

private:
    std::string name_;
};

/// Limits GDAL's block cache, which by default is a twentieth of the machine's memory.
class SmallCache {
public:
    SmallCache() { GDALSetCacheMax64(bytes); }
    SmallCache(const SmallCache&) = delete;
    SmallCache& operator=(const SmallCache&) = delete;
    ~SmallCache() { GDALSetCacheMax64(before_); }

private:
    static constexpr GIntBig bytes = 160 << 20; // three rows of tiles of 512 px, 32,768 px wide
    GIntBig before_ = GDALGetCacheMax64();
};

/// Writes the rows of a picture, from the top.
class RowWriter {
public:
    RowWriter(const PictureFrame& picture, const char* name) {
        CPLStringList options;
        options.SetNameValue("TILED", "YES");
        options.SetNameValue("BLOCKXSIZE", "512");
        options.SetNameValue("BLOCKYSIZE", "512");
        options.SetNameValue("COMPRESS", "DEFLATE");
        options.SetNameValue("ZLEVEL", "1"); // read only once, shortly afterwards
        options.SetNameValue("INTERLEAVE", "PIXEL");
        options.SetNameValue("BIGTIFF", "IF_SAFER");
        dataset_.reset(driver_in_memory("GTiff").Create(
            name, picture.width_px, picture.height_px, bands, GDT_Byte, options.List()));
        if (!dataset_) {
            fail();
        }
        place(*dataset_, picture);
    }

    void add(std::span<const std::uint8_t> rgb) {
        const int width = dataset_->GetRasterXSize();
        const int rows = int(rgb.size() / (std::size_t(bands) * std::size_t(width)));
        // GDAL takes a pointer to non-const, but only reads.
        auto* const bytes = const_cast<std::uint8_t*>(rgb.data()); // NOLINT(*-const-cast)
        if (dataset_->RasterIO(GF_Write,
                               0,
                               next_,
                               width,
                               rows,
                               bytes,
                               width,
                               rows,
                               GDT_Byte,
                               bands,
                               nullptr,
                               bands,
                               GSpacing(bands) * width,
                               1,
                               nullptr) != CE_None) {
            fail();
        }
        next_ += rows;
    }

    GDALDatasetUniquePtr finished() && {
        dataset_->FlushCache(true);
        return std::move(dataset_);
    }

private:
    static constexpr int bands = 3;
    GDALDatasetUniquePtr dataset_;
    int next_ = 0;
};

void copy_to_disk(std::span<const char> bytes, const std::filesystem::path& file) {
    std::ofstream out{file, std::ios::binary};
    out.write(bytes.data(), std::ssize(bytes));
    out.close();
    if (!out) {
        throw InputError{
            fmt::format("cannot be written: {}; the disk may be full", std::strerror(errno))};
    }
}

void write(const PictureFrame& picture, const GiveRows& give, const std::filesystem::path& file) {
    const GdalErrorScope quiet;
    const SmallCache cache;
    CPLErrorReset();
    const FileInMemory made{"picture.tif"};
    {
        const FileInMemory drawn{"rows.tif"};
        RowWriter writer{picture, drawn.name()};
        give([&](auto rows) { writer.add(rows); });
        CPLErrorReset(); // errors reported during drawing are unrelated
        const auto source = std::move(writer).finished();
        if (CPLGetLastErrorType() == CE_Failure) {
            fail();
        }
        CPLStringList options;
        options.SetNameValue("COMPRESS", "DEFLATE");
        options.SetNameValue("OVERVIEW_RESAMPLING", "AVERAGE");
        options.SetNameValue("BIGTIFF", "IF_SAFER");
        const GDALDatasetUniquePtr copy{driver_in_memory("COG").CreateCopy(
            made.name(), source.get(), FALSE, options.List(), nullptr, nullptr)};
        if (!copy) {
            fail();
        }
    }
    if (CPLGetLastErrorType() == CE_Failure) {
        fail();
    }
    copy_to_disk(made.bytes(), file);
}

} // namespace

} // namespace macadam

extern "C" void macadam_geotiff_write(const macadam::PictureFrame& picture,
                                      const macadam::GiveRows& give,
                                      const std::filesystem::path& file) {
    macadam::write(picture, give, file);
}
