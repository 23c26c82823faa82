#include "storage/gdal/gdal_access.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/gdal_errors.hpp"
#include "storage/gdal/gdal_file_guard.hpp"
#include "storage/gdal/map_kind.hpp"
#include "storage/gdal/sqlite_map.hpp"
#include "storage/gdal/virtual_raster.hpp"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <fmt/core.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <array>
#include <mutex>
#include <set>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Size of GDAL's block cache: several rows of tiles below the widest picture. By default, GDAL
/// uses a share of the machine's memory.
constexpr GIntBig cache_bytes = 128 << 20;

// Registered one by one: GDALAllRegister() would add some 200 drivers and the plug-ins of folders
// named in the environment, including drivers that contact servers, load libraries or open other
// files.
constexpr std::array drivers{RegisterOGRShape,
                             RegisterOGRFlatGeobuf,
                             RegisterOGRGeoPackage,
                             RegisterOGRGeoJSON,
                             RegisterOGRGeoJSONSeq,
                             RegisterOGRSQLite,
                             RegisterOGRGML,
                             RegisterOGRLIBKML,
                             RegisterOGRTAB,
                             RegisterOGROpenFileGDB};
constexpr std::array raster_drivers{GDALRegister_GTiff,
                                    GDALRegister_COG,
                                    GDALRegister_MEM,
                                    GDALRegister_VRT,
                                    GDALRegister_PNG,
                                    GDALRegister_JPEG,
                                    GDALRegister_JP2OpenJPEG,
                                    GDALRegister_WEBP,
                                    GDALRegister_MBTiles};

// Options that the environment could override.
constexpr std::array<std::pair<const char*, const char*>, 8> settings{
    {{"GDAL_DRIVER_PATH", "disable"},
     {"GDAL_VRT_ENABLE_PYTHON", "NO"},
     {"OGR_SQLITE_LOAD_EXTENSIONS", ""},
     {"GML_DOWNLOAD_SCHEMA", "NO"},
     {"GML_PARSER", "EXPAT"}, // the other parser fetches what a document type names
     {"GML_SKIP_RESOLVE_ELEMS", "ALL"},
     {"LIBKML_EXTERNAL_STYLE", "NO"},
     {"LIBKML_RESOLVE_STYLE", "NO"}}};

/// Refuses network requests; without an answer here, GDAL would contact the server.
CPLHTTPResult* fetch_nothing(const char* /*url*/,
                             CSLConstList /*options*/,
                             GDALProgressFunc /*progress*/,
                             void* /*progress_data*/,
                             CPLHTTPFetchWriteFunc /*write*/,
                             void* /*write_data*/,
                             void* /*user_data*/) {
    auto* const answer = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    answer->nStatus = 1;
    answer->pszErrBuf = CPLStrdup("network access is disabled");
    return answer;
}

void prepare() {
    guard_files();
    for (const auto& [name, value] : settings) {
        CPLSetConfigOption(name, value);
    }
    CPLHTTPSetFetchCallback(fetch_nothing, nullptr);
    OSRSetPROJEnableNetwork(FALSE);
    distrust_schemas();
    for (auto* const add : drivers) {
        add();
    }
    for (auto* const add : raster_drivers) {
        add();
    }
    GDALSetCacheMax64(cache_bytes);
}

void prepare_once() {
    static std::once_flag once;
    std::call_once(once, prepare);
}

GDALDriver& driver_named(const char* name) {
    prepare_once();
    auto* const found = GetGDALDriverManager()->GetDriverByName(name);
    if (found == nullptr) {
        throw InputError{fmt::format("cannot be written: this GDAL does not support {}", name)};
    }
    return *found;
}

std::shared_ptr<GDALDataset> opened(const fs::path& file, MapKind kind, unsigned purpose) {
    const std::array<const char*, 2> allowed{driver_of(kind), nullptr};
    CPLStringList options;
    if (kind == MapKind::gml) {
        options.SetNameValue("DOWNLOAD_SCHEMA", "NO");
        options.SetNameValue("WRITE_GFS", "NO");
    }
    return GDALDatasetUniquePtr{
        GDALDataset::Open(fs::absolute(file).lexically_normal().c_str(),
                          purpose | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                          allowed.data(),
                          options.List(),
                          nullptr)};
}

/// Size of a file and of those beside it with the same stem, or of all files in a folder.
std::uintmax_t bytes_of(const fs::path& file) {
    const bool is_folder = fs::is_directory(file);
    const auto stem = file.stem().string() + ".";
    std::uintmax_t bytes = 0;
    for (const auto& each :
         fs::directory_iterator{is_folder ? file : fs::absolute(file).parent_path()}) {
        std::error_code error;
        if (is_folder || each.path() == fs::absolute(file) ||
            each.path().filename().string().starts_with(stem)) {
            const auto size = each.is_regular_file(error) ? each.file_size(error) : 0;
            bytes += error ? 0 : size;
        }
    }
    return bytes;
}

void expect_pictures(const fs::path& file, MapKind kind) {
    const auto name = file.string();
    if (!may_hold_pictures(kind)) {
        throw InputError{
            may_hold_lines(kind)
                ? fmt::format("{}: contains points, lines or areas, expected a raster", name)
                : fmt::format("{}: is not a raster that GDAL can read: its first bytes are not "
                              "recognized, expected GeoTIFF, MBTiles, GeoPackage, PNG, JPEG, "
                              "JPEG 2000, WebP or a virtual raster",
                              name)};
    }
    if (kind == MapKind::mbtiles && holds_vector_tiles(file)) {
        throw InputError{fmt::format("{}: contains vector tiles, expected picture tiles", name)};
    }
    if (kind == MapKind::geopackage && !holds_pictures(file)) {
        throw InputError{
            fmt::format("{}: contains points, lines or areas, expected a raster", name)};
    }
}

} // namespace

LineDataset open_lines(const fs::path& file) {
    prepare_once();
    const auto kind = kind_of_map(file);
    if (!may_hold_lines(kind)) {
        throw InputError{fmt::format(
            "{}: cannot be read as a line layer: {}",
            file.string(),
            may_hold_pictures(kind)
                ? "it is a raster"
                : "unknown map format; expected OpenStreetMap, GeoPackage, SQLite, Shapefile, "
                  "GeoJSON, FlatGeobuf, GML, KML, MapInfo or a File Geodatabase")};
    }
    if (kind == MapKind::file_geodatabase) {
        let_read_folder(file);
    } else {
        let_read(file);
    }
    auto dataset = opened(file, kind, GDAL_OF_VECTOR);
    if (!dataset) {
        throw InputError{fmt::format("{}: cannot be read as a line layer: {}",
                                     file.string(),
                                     gdal_error("unknown map format"))};
    }
    return {std::move(dataset), bytes_of(file)};
}

RasterDataset open_raster(const fs::path& file) {
    prepare_once();
    const auto kind = kind_of_map(file);
    expect_pictures(file, kind);
    std::set<fs::path> files;
    if (kind == MapKind::virtual_raster) {
        for (const auto& source : sources_of_vrt(file)) {
            let_read(source);
            files.insert(source);
        }
    }
    let_read(file);
    auto dataset = opened(file, kind, GDAL_OF_RASTER);
    if (!dataset) {
        throw InputError{fmt::format("{}: is not a raster that GDAL can read: {}",
                                     file.string(),
                                     gdal_error("unknown GDAL error"))};
    }
    if (dataset->GetRasterCount() == 0) {
        throw InputError{fmt::format(
            "{}: contains only subdatasets, expected a raster that GDAL opens by the file name",
            file.string())};
    }
    const CPLStringList names{dataset->GetFileList()};
    for (int i = 0; i < names.Count(); ++i) {
        files.insert(names[i]);
    }
    return {std::move(dataset), {files.begin(), files.end()}};
}

GDALDriver& driver_to_write(const char* name, const fs::path& folder) {
    auto& driver = driver_named(name);
    let_write(folder);
    return driver;
}

std::shared_ptr<GDALDataset> reopen_lines(const fs::path& file, const char* driver) {
    const std::array<const char*, 2> allowed{driver, nullptr};
    return GDALDatasetUniquePtr{GDALDataset::Open(fs::absolute(file).c_str(),
                                                  GDAL_OF_VECTOR | GDAL_OF_READONLY,
                                                  allowed.data(),
                                                  nullptr,
                                                  nullptr)};
}

GDALDriver& driver_in_memory(const char* name) {
    return driver_named(name);
}

} // namespace macadam
