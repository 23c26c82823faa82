#pragma once

#include "app/cli/arguments.hpp"
#include "render/map/map_plan.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Output of a map; the suffix of the file selects the format.
struct PictureOutput {
    enum class Kind : std::uint8_t { png, geotiff, pdf };
    std::filesystem::path file;
    Kind kind = Kind::png;
    PictureSize size{}; ///< of the picture or the sheet of paper
    std::vector<PictureSize>
        other_sizes{};               ///< that suit other shapes of data, if none is asked for
    bool world_file = false;         ///< georeference beside a .png
    bool bare = false;               ///< map only, up to the edges
    bool to_standard_output = false; ///< instead of the file
    std::string crs;                 ///< "" = spherical Mercator
    double scale_denominator = 0;    ///< on paper; 0: as large as fits
};

/// Parses the output options.
/// \throws UsageError  for an unknown suffix, size or paper, or for an invalid combination.
PictureOutput parse_picture_output(const Arguments& arguments);

/// Returns all files that are written.
std::vector<std::filesystem::path> files_of(const PictureOutput& output);

inline constexpr std::string_view default_picture_size = "1600x1200";
inline constexpr std::string_view default_paper = "A4";

inline constexpr Option picture_output_option{
    "-o,--output",
    "FILE",
    "The map: .png, .tif (Cloud Optimized GeoTIFF) or .pdf (vector graphics); - for standard "
    "output."};
inline constexpr Option picture_format_option =
    one_of("png|pdf|tif", {"--format", "NAME", "Format of -o -: png or pdf.", "png"});
inline constexpr Option picture_size_option =
    in_group("page",
             {"--size",
              "WxH",
              "Pixels (1600x1200), mm (420x594mm) or a paper (A2); detail follows the scale.",
              "area of 1600x1200"});
inline constexpr Option dpi_option = in_group(
    "page",
    {"--dpi", "N", "Pixels per inch of a picture on paper.", "96 with pixels, 300 with paper"});
inline constexpr Option scale_option =
    in_group("page",
             {"--scale",
              "N",
              "Scale on paper: 25000 or 1:25000, around the middle of --bbox or of the data.",
              "as large as fits"});
inline constexpr Option world_file_option = rare(in_group(
    "page",
    {"--world-file", "", "Write .pgw and .png.aux.xml beside a .png, to georeference it."}));
inline constexpr Option bare_option = rare(in_group(
    "page", {"--bare", "", "Map only, without title, legend and scale bar, at most --size."}));
inline constexpr Option crs_option =
    rare(in_group("page",
                  {"--crs",
                   "CRS",
                   "Map projection, as known to PROJ: EPSG:3006, a PROJ string or WKT.",
                   "EPSG:3857"}));
inline constexpr Option paper_option =
    preference(one_of("A4|A0|A1|A2|A3|A5|letter|legal|tabloid",
                      in_group("page",
                               {"--paper",
                                "NAME",
                                "Paper size of a .pdf: A0 to A5, letter, legal or tabloid.",
                                default_paper})));
inline constexpr Option landscape_option =
    in_group("page", {"--landscape", "", "Landscape paper."});

/// Returns the requested projection; null: spherical Mercator.
std::shared_ptr<const PlaneProjection> projection_of(const PictureOutput& output);

/// Draws the map and writes it. The file appears complete or not at all.
///
/// \param made          creation time in PDF metadata, ISO 8601 in UTC; "" = not known
/// \param expect_valid  throws if the picture must not be written after all
/// \returns             size of the picture, for people: "1600 x 1200 pixels"
/// \throws InputError   also if `progress`, which counts rows of pixels, requests a stop
std::string write_picture(MapPlan plan,
                          const PictureOutput& output,
                          const std::string& made,
                          const Progress& progress,
                          const std::function<void()>& expect_valid);

} // namespace macadam
