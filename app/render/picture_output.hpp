#pragma once

#include "app/cli/arguments.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace macadam {

/// How a map is handed on: the suffix of its name says as what.
struct PictureOutput {
    enum class Kind : std::uint8_t { png, geotiff, pdf };
    std::filesystem::path file;
    Kind kind = Kind::png;
    int width_px = 0, height_px = 0; ///< of the picture, or of the sheet of paper
    bool world_file = false;         ///< beside a .png: where its pixels lie
    bool bare = false;               ///< the map alone, to its edges
    std::string crs;                 ///< "" = spherical Mercator
};

/// \throws UsageError  for an unknown suffix, size or paper, or options that do not go together.
PictureOutput parse_picture_output(const Arguments& arguments);

/// All that is written.
std::vector<std::filesystem::path> files_of(const PictureOutput& output);

inline constexpr std::string_view default_picture_size = "1600x1200";
inline constexpr std::string_view default_paper = "A4";

inline constexpr Option picture_output_option{
    "-o,--output",
    "FILE",
    "The map: .png, .tif (Cloud Optimized GeoTIFF) or .pdf (vector graphics)."};
inline constexpr Option picture_size_option{
    "--size",
    "WxH",
    "Pixels, 256 to 32768 per side; lines and text scale with it.",
    default_picture_size};
inline constexpr Option world_file_option{
    "--world-file", "", "Write .pgw and .png.aux.xml beside a .png, to georeference it."};
inline constexpr Option bare_option{
    "--bare", "", "Map only, without title, legend and scale bar, at most --size."};
inline constexpr Option crs_option{
    "--crs",
    "CRS",
    "Map projection, as known to PROJ: EPSG:3006, a PROJ string or WKT.",
    "EPSG:3857"};
inline constexpr Option paper_option{
    "--paper", "NAME", "Paper size of a .pdf: A0 to A5, letter, legal or tabloid.", default_paper};
inline constexpr Option landscape_option{"--landscape", "", "Landscape paper."};

/// The projection that was asked for; null: spherical Mercator.
std::shared_ptr<const PlaneProjection> projection_of(const PictureOutput& output);

/// Draws the scene and writes it. The file appears when it is whole, or not at all.
///
/// \param made  when, ISO 8601 in UTC, as a PDF says it; "" = not known
/// \returns     what was written, for people: "1600 x 1200 pixels".
/// \param expect_valid  throws where what was drawn must not be written after all
/// \throws InputError   also when `progress`, which counts rows of pixels, is told to stop.
std::string write_picture(MapScene scene,
                          MapStyle style,
                          const PictureOutput& output,
                          const std::string& made,
                          const Progress& progress,
                          const std::function<void()>& expect_valid);

} // namespace macadam
