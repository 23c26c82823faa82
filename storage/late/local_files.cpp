#include "storage/late/local_files.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <cpl_vsi_virtual.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <set>
#include <string>
#include <string_view>

namespace macadam {
namespace {

// Drivers that ask servers by ways of their own.
constexpr std::string_view asking_drivers =
    "WMS,WMTS,WCS,HTTP,DAAS,OGCAPI,STACTA,STACIT,PLMOSAIC,PLSCENES,EEDA,EEDAI,NGW,PostGISRaster,"
    "netCDF,DODS,JPIPKAK";

// GDAL's file systems that are on this machine, or inside of another file. All others are closed.
constexpr std::array<std::string_view, 9> local_systems{"/vsimem/",
                                                        "/vsizip/",
                                                        "/vsitar/",
                                                        "/vsigzip/",
                                                        "/vsi7z/",
                                                        "/vsirar/",
                                                        "/vsisubfile/",
                                                        "/vsisparse/",
                                                        "/vsicached?"};

void* open_nothing(void* /*system*/, const char* /*name*/, const char* /*access*/) {
    errno = ENOENT;
    return nullptr;
}

int find_nothing(void* /*system*/, const char* /*name*/, VSIStatBufL* /*found*/, int /*flags*/) {
    errno = ENOENT;
    return -1;
}

/// As long as the program lives: GDAL keeps pointers to names of file systems, and forgets those
/// that it had.
struct Closed {
    CPLStringList names{VSIGetFileSystemsPrefixes()};
    std::vector<VSIFilesystemHandler*> before{};
};

void close_file_systems() {
    static auto* const systems = new Closed;
    struct Free {
        void operator()(VSIFilesystemPluginCallbacksStruct* callbacks) const {
            VSIFreeFilesystemPluginCallbacksStruct(callbacks);
        }
    };
    const std::unique_ptr<VSIFilesystemPluginCallbacksStruct, Free> closed{
        VSIAllocFilesystemPluginCallbacksStruct()};
    closed->open = open_nothing;
    closed->stat = find_nothing;
    for (int i = 0; i < systems->names.Count(); ++i) {
        const char* const prefix = systems->names[i];
        if (*prefix != '\0' && std::ranges::find(local_systems, prefix) == local_systems.end()) {
            systems->before.push_back(VSIFileManager::GetHandler(prefix));
            VSIInstallPluginHandler(prefix, closed.get());
        }
    }
}

bool is_virtual(const std::filesystem::path& file) {
    return file.extension() == ".vrt" || file.extension() == ".VRT";
}

void add_files(GDALDataset& raster, std::set<std::filesystem::path>& files) {
    const CPLStringList names{raster.GetFileList()};
    for (int i = 0; i < names.Count(); ++i) {
        const char* const name = names[i];
        // A virtual raster names its sources, but not those of sources that are virtual too.
        if (files.insert(name).second && is_virtual(name)) {
            const GDALDatasetUniquePtr source{GDALDataset::Open(name, GDAL_OF_RASTER)};
            if (source) {
                add_files(*source, files);
            }
        }
    }
}

} // namespace

void keep_off_the_network() {
    static bool is_off = false;
    if (is_off) {
        return;
    }
    is_off = true;
    const std::string skipped = CPLGetConfigOption("GDAL_SKIP", "");
    CPLSetConfigOption(
        "GDAL_SKIP",
        std::string{asking_drivers}.append(skipped.empty() ? "" : "," + skipped).c_str());
    OSRSetPROJEnableNetwork(FALSE);
    close_file_systems();
}

std::vector<std::filesystem::path> files_of(GDALDataset& raster) {
    std::set<std::filesystem::path> files;
    add_files(raster, files);
    return {files.begin(), files.end()};
}

} // namespace macadam
