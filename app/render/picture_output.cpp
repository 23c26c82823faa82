#include "app/render/picture_output.hpp"

#include "app/cli/console.hpp"
#include "app/cli/row_output.hpp"
#include "app/render/sheet_size.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "render/canvas/png.hpp"
#include "render/map/sheet_shape.hpp"
#include "render/projection/projection.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/rasters/georeferenced_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Kind = PictureOutput::Kind;

constexpr double mm_per_inch = 25.4;
constexpr std::string_view web_mercator = "EPSG:3857";

/// Returns sizes of a picture or a sheet that are taken where `size` would be empty for a third,
/// unless one is asked for.
std::vector<PictureSize>
other_sizes(const Arguments& arguments, Kind kind, const PictureSize& size) {
    if (arguments.value("--size") || arguments.value("--paper") || arguments.flag("--landscape") ||
        arguments.flag("--bare")) {
        return {};
    }
    if (kind != Kind::pdf) {
        return other_shapes(size);
    }
    auto turned = size;
    std::swap(turned.width_px, turned.height_px);
    return {turned};
}

Kind kind_of(const std::string& file) {
    if (file.ends_with(".png")) {
        return Kind::png;
    }
    if (file.ends_with(".tif") || file.ends_with(".tiff")) {
        return Kind::geotiff;
    }
    if (file.ends_with(".pdf")) {
        return Kind::pdf;
    }
    throw UsageError{
        fmt::format("-o is '{}', expected a name that ends in .png, .tif or .pdf", file)};
}

void expect_fitting(const Arguments& arguments, Kind kind) {
    if (kind == Kind::pdf && arguments.is_given("--dpi")) {
        throw UsageError{"--dpi is for pictures; a .pdf has lines and letters instead of pixels"};
    }
    if (kind == Kind::pdf && arguments.is_given("--paper") && arguments.value("--size")) {
        throw UsageError{"--paper and --size cannot be combined"};
    }
    if (kind != Kind::pdf && arguments.is_given("--paper")) {
        throw UsageError{"--paper is for a .pdf, expected --size A4 with a picture"};
    }
    if (kind != Kind::pdf && arguments.flag("--landscape") &&
        !is_paper(arguments.value("--size").value_or(""))) {
        throw UsageError{"--landscape turns paper, expected --size A4 with a picture"};
    }
    if (const auto crs = arguments.value("--crs"); crs && crs->empty()) {
        throw UsageError{"--crs is '', expected a projection such as EPSG:3006"};
    }
    if (arguments.is_given("--scale") && arguments.flag("--bare")) {
        throw UsageError{"--scale and --bare cannot be combined"};
    }
    if (kind != Kind::png && arguments.flag("--world-file")) {
        throw UsageError{"--world-file is for a .png; a .tif is georeferenced itself"};
    }
}

/// Returns the size of a bare map: the sheet's, or the largest of the box's own shape within the
/// requested size of a picture.
PictureSize bare_size(const MapScene& scene, const PictureOutput& output) {
    const auto& most = output.size;
    if (output.kind == Kind::pdf) {
        return most;
    }
    const auto plane = plane_extent(scene.box, scene.projection.get());
    const double scale = std::min(most.width_px / std::max(1e-12, plane.width_rad),
                                  most.height_px / std::max(1e-12, plane.height_rad));
    const auto side = [&](double rad, int most_px) {
        return std::clamp(int(std::lround(rad * scale)), min_image_px, most_px);
    };
    auto size = most;
    size.width_px = side(plane.width_rad, most.width_px);
    size.height_px = side(plane.height_rad, most.height_px);
    return size;
}

/// Plans the map without anything around it.
MapPlan bare_plan(const MapPlan& plan, const PictureOutput& output) {
    auto scene = plan.scene();
    auto style = plan.style();
    scene.title.clear();
    scene.subtitle.clear();
    scene.attribution.clear();
    scene.scale_bar = false;
    scene.to_the_edge = true;
    style.legend = false;
    const auto size = bare_size(scene, output);
    return {std::move(scene), std::move(style), size};
}

PictureFrame placed(const MapPlan& plan) {
    const auto place = plan.place();
    const auto& projection = plan.scene().projection;
    return {.width_px = plan.size().width_px,
            .height_px = plan.size().height_px,
            .left = place.left,
            .top = place.top,
            .per_px = place.per_px,
            .wkt = projection ? projection->wkt : plane_projection(std::string{web_mercator})->wkt,
            .copyright = {}};
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
    AtomicFile file{path};
    file.write(bytes);
    file.commit();
}

void expect_not_stopped(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped before the picture was complete"};
    }
}

using ExpectValid = std::function<void()>;

void give_png(MapPlan& plan,
              const PngWriter::PutBytes& put,
              const Progress& progress,
              const ExpectValid& expect_valid) {
    PngWriter png{plan.size(), put};
    plan.draw([&](auto rows) { png.add(rows); }, progress);
    png.finish();
    expect_valid();
}

void write_png(MapPlan& plan,
               const PictureOutput& output,
               const Progress& progress,
               const ExpectValid& expect_valid) {
    if (output.world_file) {
        write_png_with_world_file(
            [&](const auto& take) { give_png(plan, take, progress, expect_valid); },
            placed(plan),
            output.file);
        return;
    }
    if (output.to_standard_output) {
        give_png(plan, print, progress, expect_valid);
        return;
    }
    AtomicFile file{output.file};
    give_png(
        plan, [&](std::string_view bytes) { file.write(bytes); }, progress, expect_valid);
    file.commit();
}

} // namespace

PictureOutput parse_picture_output(const Arguments& arguments) {
    const auto file = arguments.value("--output");
    if (!file) {
        throw UsageError{"-o map.png is missing"};
    }
    const bool to_standard_output = *file == standard_output;
    if (!to_standard_output && arguments.value("--format")) {
        throw UsageError{"--format is for -o -; the name of a file tells its format"};
    }
    const auto kind = kind_of(to_standard_output ? "map." + arguments.choice("--format") : *file);
    if (to_standard_output && (kind == Kind::geotiff || arguments.flag("--world-file"))) {
        throw UsageError{"-o - cannot write a .tif or a world file, which need a file; expected "
                         "--format png or pdf"};
    }
    expect_fitting(arguments, kind);
    const auto size = kind == Kind::pdf ? pdf_size(arguments) : picture_size(arguments);
    const auto scale = parse_scale(arguments);
    return {.file = *file,
            .kind = kind,
            .size = size,
            .other_sizes = other_sizes(arguments, kind, size),
            .world_file = arguments.flag("--world-file"),
            .bare = arguments.flag("--bare"),
            .to_standard_output = to_standard_output,
            .crs = arguments.value("--crs").value_or(""),
            .scale_denominator = scale.value_or(0)};
}

std::vector<std::filesystem::path> files_of(const PictureOutput& output) {
    if (output.to_standard_output) {
        return {};
    }
    std::vector files{output.file};
    if (output.world_file) {
        files.push_back(world_file_of(output.file));
        files.push_back(auxiliary_file_of(output.file));
    }
    return files;
}

std::shared_ptr<const PlaneProjection> projection_of(const PictureOutput& output) {
    const bool is_mercator =
        output.crs.empty() || in_lower_case(output.crs) == in_lower_case(std::string{web_mercator});
    return is_mercator ? nullptr : plane_projection(output.crs);
}

std::string write_picture(MapPlan plan,
                          const PictureOutput& output,
                          const std::string& made,
                          const Progress& progress,
                          const std::function<void()>& expect_valid) {
    const auto copyright = plan.scene().attribution;
    const auto title = plan.scene().title;
    if (output.bare) {
        plan = bare_plan(plan, output);
    }
    const auto [width_px, height_px, band_px, px_per_inch, is_on_paper] = plan.size();
    if (output.kind == Kind::pdf) {
        const auto pdf = plan.pdf({.width_px = double(width_px),
                                   .height_px = double(height_px),
                                   .px_per_inch = px_per_inch,
                                   .title = title,
                                   .author = copyright,
                                   .made = made});
        expect_not_stopped(progress);
        expect_valid();
        output.to_standard_output ? print(pdf) : write_bytes(output.file, pdf);
        return fmt::format("{:.0f} x {:.0f} mm",
                           width_px / px_per_inch * mm_per_inch,
                           height_px / px_per_inch * mm_per_inch);
    }
    if (output.kind == Kind::geotiff) {
        auto picture = placed(plan);
        picture.copyright = copyright;
        write_geotiff(
            picture,
            [&](const auto& take) {
                plan.draw(take, progress);
                expect_valid();
            },
            output.file);
    } else {
        write_png(plan, output, progress, expect_valid);
    }
    return fmt::format("{} x {} pixels", width_px, height_px);
}

} // namespace macadam
