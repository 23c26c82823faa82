#include "storage/rasters/georeferenced_picture.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/rasters/geotiff_plugin.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/core.h>

#include <fstream>
#include <utility>

namespace macadam {
namespace {

void put(const std::filesystem::path& file, const GiveBytes& give) {
    std::ofstream out{file, std::ios::binary};
    const auto expect_written = [&] {
        if (!out) {
            throw InputError{
                fmt::format("{}: cannot be written; the disk may be full", file.string())};
        }
    };
    give([&](std::string_view bytes) {
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        expect_written();
    });
    out.close();
    expect_written();
}

GiveBytes all_of(std::string text) {
    return [text = std::move(text)](const auto& take) { take(text); };
}

/// World file: six lines, for the centre of the first pixel.
std::string world_text(const PictureFrame& picture) {
    return fmt::format("{}\n0\n0\n{}\n{}\n{}\n",
                       picture.per_px,
                       -picture.per_px,
                       picture.left + picture.per_px / 2,
                       picture.top - picture.per_px / 2);
}

/// GDAL's Persistent Auxiliary Metadata, from which QGIS also reads the coordinate system.
std::string auxiliary_text(const PictureFrame& picture) {
    return fmt::format("<PAMDataset>\n  <SRS dataAxisToSRSAxisMapping=\"1,2\">{}</SRS>\n"
                       "</PAMDataset>\n",
                       xml_text(picture.wkt));
}

} // namespace

void write_geotiff(const PictureFrame& picture,
                   const GiveRows& give,
                   const std::filesystem::path& file) {
    auto* const write = plugin_function<GeotiffWrite>("macadam_gdal.so", geotiff_write_name);
    AtomicFileSet files{file};
    try {
        write(picture, give, files.folder() / file.filename());
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}", file.string(), error.what())};
    }
    files.commit();
}

void write_png_with_world_file(const GiveBytes& png,
                               const PictureFrame& picture,
                               const std::filesystem::path& file) {
    AtomicFileSet files{file};
    const auto name = file.filename();
    put(files.folder() / name, png);
    put(files.folder() / world_file_of(name), all_of(world_text(picture)));
    put(files.folder() / auxiliary_file_of(name), all_of(auxiliary_text(picture)));
    files.commit();
}

std::filesystem::path auxiliary_file_of(std::filesystem::path picture) {
    return picture += ".aux.xml";
}

std::filesystem::path world_file_of(const std::filesystem::path& picture) {
    auto file = picture;
    return file.replace_extension(".pgw");
}

} // namespace macadam
