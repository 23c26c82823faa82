#include "storage/picture_file.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/late_library.hpp"
#include "storage/atomic_file_set.hpp"
#include "storage/late/geotiff.hpp"
#include "storage/xml_text.hpp"

#include <fmt/core.h>

#include <fstream>

namespace macadam {
namespace {

void put(const std::filesystem::path& file, std::string_view bytes) {
    std::ofstream out{file, std::ios::binary};
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        throw InputError{fmt::format("{}: cannot be written; the disk may be full", file.string())};
    }
}

/// Six lines, for the middle of the first pixel.
std::string world_text(const PlacedPicture& picture) {
    return fmt::format("{}\n0\n0\n{}\n{}\n{}\n",
                       picture.per_px,
                       -picture.per_px,
                       picture.left + picture.per_px / 2,
                       picture.top - picture.per_px / 2);
}

/// GDAL's Persistent Auxiliary Metadata, of which QGIS reads the system too.
std::string auxiliary_text(const PlacedPicture& picture) {
    return fmt::format("<PAMDataset>\n  <SRS dataAxisToSRSAxisMapping=\"1,2\">{}</SRS>\n"
                       "</PAMDataset>\n",
                       xml_text(picture.wkt));
}

} // namespace

void write_geotiff(const PlacedPicture& picture, const std::filesystem::path& file) {
    auto* const write = late_function<GeotiffWrite>("macadam_gdal.so", geotiff_write_name);
    AtomicFileSet files{file};
    try {
        write(picture, files.folder() / file.filename());
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}", file.string(), error.what())};
    }
    files.commit();
}

void write_png_with_world_file(std::string_view png,
                               const PlacedPicture& picture,
                               const std::filesystem::path& file) {
    AtomicFileSet files{file};
    const auto name = file.filename();
    put(files.folder() / name, png);
    put(files.folder() / world_file_of(name), world_text(picture));
    put(files.folder() / (name.string() + ".aux.xml"), auxiliary_text(picture));
    files.commit();
}

std::filesystem::path world_file_of(const std::filesystem::path& picture) {
    auto file = picture;
    return file.replace_extension(".pgw");
}

} // namespace macadam
