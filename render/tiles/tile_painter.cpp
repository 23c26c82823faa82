#include "render/tiles/tile_painter.hpp"

#include "estimator/common/error.hpp"
#include "render/gl/gl_context.hpp"
#include "render/gl/gl_program.hpp"
#include "render/gl/vertex_buffer.hpp"
#include "render/labels/label_painter.hpp"
#include "render/tiles/tile_labels.hpp"
#include "render/tiles/tile_quads.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace macadam {
namespace {

constexpr int min_tile_px = 64;
constexpr int max_tile_px = 4096;
constexpr int max_side_px = 8192;

// OpenGL clips at its view, and clipped triangles need not meet as the original ones do. The view
// is therefore larger than the window by more than the length of a line segment, and the window is
// cut out of it.
constexpr int beyond_px = 512;

constexpr auto floats = VertexPart::Kind::floats;
constexpr std::array vertex_parts{
    VertexPart{floats, 2, offsetof(QuadVertex, x_px)},
    VertexPart{floats, 4, offsetof(QuadVertex, from_x_px)},
    VertexPart{floats, 2, offsetof(QuadVertex, dx)},
    VertexPart{floats, 4, offsetof(QuadVertex, start_x)},
    VertexPart{floats, 3, offsetof(QuadVertex, start_limit_px)},
    VertexPart{VertexPart::Kind::shares, 3, offsetof(QuadVertex, rgba)}};

constexpr const char* vertex_shader = R"(#version 330 core
uniform float view_px;
uniform float beyond_px;
layout(location = 0) in vec2 place_px;
layout(location = 1) in vec4 ends_px;
layout(location = 2) in vec2 along;
layout(location = 3) in vec4 outwards;
layout(location = 4) in vec3 limits_and_radius;
layout(location = 5) in vec3 colour;
flat out vec4 ends;
flat out vec2 direction;
flat out vec4 out_of_ends;
flat out vec3 reach;
flat out vec3 paint;
void main() {
    ends = ends_px;
    direction = along;
    out_of_ends = outwards;
    reach = limits_and_radius;
    paint = colour;
    gl_Position = vec4(2.0 * (place_px + beyond_px) / view_px - 1.0, 0.0, 1.0);
}
)";

// Coverage is the part of a one pixel wide window across the line that lies on it, which is also
// right for lines thinner than a pixel. Values are not interpolated: the pixel's position relative
// to the line segment is exact, so the result does not depend on their position in the window.
constexpr const char* fragment_shader = R"(#version 330 core
flat in vec4 ends;
flat in vec2 direction;
flat in vec4 out_of_ends;
flat in vec3 reach;
flat in vec3 paint;
out vec4 pixel;
float left_over(float beyond, float limit) {
    return limit < 0.0 ? clamp(0.5 - beyond, 0.0, 1.0) : (beyond < limit ? 1.0 : 0.0);
}
void main() {
    vec2 start = gl_FragCoord.xy - ends.xy;
    vec2 end = gl_FragCoord.xy - ends.zw;
    float across = start.y * direction.x - start.x * direction.y;
    float past = max(max(-dot(start, direction), dot(end, direction)), 0.0);
    float away = length(vec2(past, across));
    float covered = min(away + 0.5, reach.z) - max(away - 0.5, -reach.z);
    pixel = vec4(paint, clamp(covered, 0.0, 1.0) *
                        left_over(dot(start, out_of_ends.xy), reach.x) *
                        left_over(dot(end, out_of_ends.zw), reach.y));
}
)";

const TileLook& checked(const TileLook& look) {
    if (look.tile_px < min_tile_px || look.tile_px > max_tile_px) {
        throw InputError{fmt::format(
            "tile size '{}', expected {} to {} px", look.tile_px, min_tile_px, max_tile_px)};
    }
    if (look.across < 1 || look.across > max_side_px / look.tile_px) {
        throw InputError{fmt::format("'{}' tiles of {} px across, expected 1 to {}",
                                     look.across,
                                     look.tile_px,
                                     max_side_px / look.tile_px)};
    }
    return look;
}

const ClassTable& classes_of(const MapStyle& style) {
    return style.classes != nullptr ? *style.classes : *class_table("fhwa");
}

TileColours colours_of(const MapStyle& style) {
    return {palette(style), class_colours(style, classes_of(style).classes.size())};
}

LineWidths widths_of(const MapStyle& style, const WorldScale& scale) {
    auto widths = tile_widths(zoom_of_256_px(scale));
    widths.core_px *= style.lines.width;
    widths.casing_px *= style.lines.casing;
    return widths;
}

/// Limits Mesa to one thread, since its threads mostly wait for each other; use processes for
/// parallel drawing.
const TileLook& with_one_thread(const TileLook& look) {
    setenv("LP_NUM_THREADS", "0", 0);
    return look;
}

Image with_labels(Image roads,
                  std::span<const Label> labels,
                  const WorldWindow& window,
                  const Palette& colours,
                  TypeSetter& setter) {
    if (labels.empty()) {
        return roads;
    }
    Canvas canvas{std::move(roads)};
    draw_labels(canvas,
                labels,
                {int(window.left_px), int(window.top_px)},
                {colours.ink, colours.quiet_ink, colours.ground},
                setter);
    return std::move(canvas).finished();
}

std::vector<std::uint8_t> rgb_of(std::span<const std::uint8_t> rgba) {
    std::vector<std::uint8_t> rgb(rgba.size() / 4 * 3 + 1);
    auto* to = rgb.data();
    for (std::size_t i = 0; i < rgba.size(); i += 4, to += 3) {
        std::memcpy(to, rgba.data() + i, 4); // the fourth byte is overwritten
    }
    rgb.pop_back();
    return rgb;
}

std::size_t pixels_of(const TileLook& look) {
    const auto side = std::size_t(look.tile_px) * std::size_t(look.across);
    return side * side;
}

} // namespace

struct TilePainter::Impl {
    explicit Impl(const TileLook& wanted);
    void paint(std::span<const TileQuad> shown) const;
    void check_classes(std::span<const MapLine> lines) const;

    TileLook look;
    TypeSetter setter;
    TileColours colours;
    std::vector<std::uint8_t> rgba;
    GlContext context;
    VertexBuffer quads{context, sizeof(QuadVertex), vertex_parts};

#define MACADAM_GL(type, name) type name = context.entry<type>("gl" #name)
    MACADAM_GL(decltype(&glBlendFunc), BlendFunc);
    MACADAM_GL(decltype(&glClear), Clear);
    MACADAM_GL(decltype(&glClearColor), ClearColor);
    MACADAM_GL(decltype(&glEnable), Enable);
    MACADAM_GL(decltype(&glFinish), Finish);
    MACADAM_GL(decltype(&glGetError), GetError);
    MACADAM_GL(decltype(&glScissor), Scissor);
    MACADAM_GL(decltype(&glViewport), Viewport);
    MACADAM_GL(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation);
    MACADAM_GL(PFNGLUNIFORM1FPROC, Uniform1f);
    MACADAM_GL(PFNGLUSEPROGRAMPROC, UseProgram);
#undef MACADAM_GL
};

TilePainter::Impl::Impl(const TileLook& wanted)
    : look{with_one_thread(checked(wanted))}, colours{colours_of(look.style)},
      rgba(pixels_of(look) * 4), context{
                                     rgba, look.tile_px * look.across, look.tile_px * look.across} {
    const int side_px = look.tile_px * look.across;
    const GLuint program = linked_program(context, vertex_shader, fragment_shader);
    UseProgram(program);
    Uniform1f(GetUniformLocation(program, "view_px"), float(side_px + 2 * beyond_px));
    Uniform1f(GetUniformLocation(program, "beyond_px"), float(beyond_px));
    Viewport(-beyond_px, -beyond_px, side_px + 2 * beyond_px, side_px + 2 * beyond_px);
    Enable(GL_SCISSOR_TEST);
    Scissor(0, 0, side_px, side_px);
    Enable(GL_BLEND);
    BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    const auto part = [&](unsigned shift) {
        return float(colours.palette.ground >> shift & 255U) / 255;
    };
    ClearColor(part(16), part(8), part(0), 1);
}

/// Draws all quads in one call: colours and widths are part of the vertices.
void TilePainter::Impl::paint(std::span<const TileQuad> shown) const {
    context.make_current();
    Clear(GL_COLOR_BUFFER_BIT);
    quads.draw(shown);
    Finish();
    if (const GLenum error = GetError(); error != GL_NO_ERROR) {
        throw InputError{fmt::format("OSMesa cannot draw the tile: OpenGL error {:#x}", error)};
    }
}

void TilePainter::Impl::check_classes(std::span<const MapLine> lines) const {
    const int last = int(colours.classes.size()) - 1;
    for (const auto& line : lines) {
        if (line.iri_class < -1 || line.iri_class > last) {
            throw InputError{fmt::format("a line of class '{}', expected -1 to {} as in table '{}'",
                                         line.iri_class,
                                         last,
                                         classes_of(look.style).name)};
        }
    }
}

TilePainter::TilePainter(const TileLook& look) : impl_{std::make_unique<Impl>(look)} {}
TilePainter::~TilePainter() = default;
TilePainter::TilePainter(TilePainter&&) noexcept = default;
TilePainter& TilePainter::operator=(TilePainter&&) noexcept = default;

Image TilePainter::draw(const TileId& first, std::span<const MapLine> lines) {
    impl_->check_classes(lines);
    const auto& look = impl_->look;
    const auto window = window_of(first, look.tile_px, look.across);
    const auto widths = widths_of(look.style, window.scale);
    const auto strands = tile_strands(lines, window, widths, look.style.left_hand_traffic);
    impl_->paint(tile_quads(strands, window, widths, impl_->colours));

    Image image{window.side_px, window.side_px, rgb_of(impl_->rgba)};
    if (!look.style.labels) {
        return image;
    }
    return with_labels(std::move(image),
                       tile_labels(lines, window, widths, impl_->setter),
                       window,
                       impl_->colours.palette,
                       impl_->setter);
}

double TilePainter::reach_px(int zoom) const {
    const auto widths = widths_of(impl_->look.style, {zoom, impl_->look.tile_px});
    // At bends, the offset of a line is at most doubled.
    return 2 * way_offset_px(widths, 0) + casing_radius_px(widths, 0, true) + 1;
}

} // namespace macadam
