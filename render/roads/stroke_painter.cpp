#include "render/roads/stroke_painter.hpp"

#include "estimator/common/error.hpp"
#include "render/gl/gl_program.hpp"
#include "render/gl/vertex_buffer.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace macadam {
namespace {

// OpenGL clips at its view, and clipped triangles need not meet as the original ones do. The view
// is therefore larger than the window by more than the length of a quad. Its side is a power of
// two, so that positions in 1/256 px reach the rasteriser without rounding.
constexpr int view_px = max_window_px;
constexpr int beyond_px = (view_px - max_stroke_window_px) / 2;

constexpr std::array vertex_parts{VertexPart{2, offsetof(StrokeVertex, x_px)},
                                  VertexPart{2, offsetof(StrokeVertex, anchor_x_px)},
                                  VertexPart{3, offsetof(StrokeVertex, across)},
                                  VertexPart{3, offsetof(StrokeVertex, before)},
                                  VertexPart{3, offsetof(StrokeVertex, after)},
                                  VertexPart{2, offsetof(StrokeVertex, round_before)}};

// The picture's first row is OpenGL's bottom row, so y is not flipped.
constexpr const char* vertex_shader = R"(#version 330 core
uniform float half_views_per_px;
uniform float beyond_px;
layout(location = 0) in vec2 place_px;
layout(location = 1) in vec2 anchor_px;
layout(location = 2) in vec3 across_line;
layout(location = 3) in vec3 before_line;
layout(location = 4) in vec3 after_line;
layout(location = 5) in vec2 round_ends;
flat out vec2 anchor;
flat out vec3 across_piece;
flat out vec3 before_piece;
flat out vec3 after_piece;
flat out vec2 rounds;
void main() {
    anchor = anchor_px;
    across_piece = across_line;
    before_piece = before_line;
    after_piece = after_line;
    rounds = round_ends;
    gl_Position = vec4((place_px + beyond_px) * half_views_per_px - 1.0, 0.0, 1.0);
}
)";

// Coverage is the part of a one pixel wide window across the line that lies on the stroke,
// which is also right for lines thinner than a pixel. Values are not interpolated: the pixel's
// position relative to the anchor is exact, so the result does not depend on their position in the
// window.
constexpr const char* fragment_shader = R"(#version 330 core
uniform vec3 colour;
uniform float radius_px;
flat in vec2 anchor;
flat in vec3 across_piece;
flat in vec3 before_piece;
flat in vec3 after_piece;
flat in vec2 rounds;
out vec4 pixel;
void main() {
    vec3 place = vec3(gl_FragCoord.xy - anchor, 1.0);
    vec2 past = vec2(dot(place, before_piece), dot(place, after_piece));
    vec2 cap = max(past, 0.0) * rounds;
    vec2 cut = mix(clamp(0.5 - past, 0.0, 1.0), vec2(1.0), rounds);
    float away = length(vec2(max(cap.x, cap.y), dot(place, across_piece)));
    float across = min(away + 0.5, radius_px) - max(away - 0.5, -radius_px);
    pixel = vec4(colour, clamp(across, 0.0, 1.0) * cut.x * cut.y);
}
)";

std::array<float, 3> channels(std::uint32_t rgb) {
    return {float(rgb >> 16 & 255U) / 255, float(rgb >> 8 & 255U) / 255, float(rgb & 255U) / 255};
}

} // namespace

struct StrokePainter::Gl {
    explicit Gl(const GlContext& context);

#define MACADAM_GL(type, name) type name = context_.entry<type>("gl" #name)
    const GlContext& context_;
    MACADAM_GL(decltype(&glBlendFunc), BlendFunc);
    MACADAM_GL(decltype(&glClear), Clear);
    MACADAM_GL(decltype(&glClearColor), ClearColor);
    MACADAM_GL(decltype(&glEnable), Enable);
    MACADAM_GL(decltype(&glGetError), GetError);
    MACADAM_GL(decltype(&glScissor), Scissor);
    MACADAM_GL(decltype(&glViewport), Viewport);
    MACADAM_GL(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation);
    MACADAM_GL(PFNGLUNIFORM1FPROC, Uniform1f);
    MACADAM_GL(PFNGLUNIFORM3FPROC, Uniform3f);
    MACADAM_GL(PFNGLUSEPROGRAMPROC, UseProgram);
#undef MACADAM_GL

    VertexBuffer quads{context_, sizeof(StrokeVertex), vertex_parts};
    GLint colour = -1;
    GLint radius_px = -1;
};

StrokePainter::Gl::Gl(const GlContext& context) : context_{context} {}

StrokePainter::StrokePainter(const GlContext& context) : gl_{std::make_unique<Gl>(context)} {
    const GLuint program = linked_program(context, vertex_shader, fragment_shader);
    gl_->UseProgram(program);
    gl_->colour = gl_->GetUniformLocation(program, "colour");
    gl_->radius_px = gl_->GetUniformLocation(program, "radius_px");
    gl_->Uniform1f(gl_->GetUniformLocation(program, "half_views_per_px"), 2.F / view_px);
    gl_->Uniform1f(gl_->GetUniformLocation(program, "beyond_px"), float(beyond_px));
    gl_->Viewport(-beyond_px, -beyond_px, view_px, view_px);
    gl_->Enable(GL_SCISSOR_TEST);
    gl_->Enable(GL_BLEND);
    gl_->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

StrokePainter::~StrokePainter() = default;

void StrokePainter::clear(const PixelBox& box, std::uint32_t rgb) {
    const auto [red, green, blue] = channels(rgb);
    gl_->Scissor(int(std::lround(box.left)),
                 int(std::lround(box.top)),
                 int(std::lround(box.width())),
                 int(std::lround(box.height())));
    gl_->ClearColor(red, green, blue, 1);
    gl_->Clear(GL_COLOR_BUFFER_BIT);
}

void StrokePainter::draw(std::span<const StrokeQuad> quads, std::uint32_t rgb, double radius_px) {
    const auto [red, green, blue] = channels(rgb);
    gl_->Uniform3f(gl_->colour, red, green, blue);
    gl_->Uniform1f(gl_->radius_px, float(radius_px));
    gl_->quads.draw(quads);
}

void StrokePainter::finish() {
    gl_->context_.finish();
    if (const GLenum error = gl_->GetError(); error != GL_NO_ERROR) {
        throw InputError{fmt::format("the map cannot be drawn: OpenGL error {:#x}", error)};
    }
}

} // namespace macadam
