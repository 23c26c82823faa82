#include "render/gl/vertex_buffer.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace macadam {
namespace {

constexpr std::size_t quads_per_call = 16384; // 4 MB of vertices
constexpr std::size_t corners_of_quad = 4;
constexpr std::size_t indices_of_quad = 6;

} // namespace

struct VertexBuffer::Gl {
    Gl(const GlContext& context, std::size_t bytes)
        : context_{context}, quad_bytes{corners_of_quad * bytes} {}

#define MACADAM_GL(type, name) type name = context_.entry<type>("gl" #name)
    const GlContext& context_;
    MACADAM_GL(decltype(&glDrawElements), DrawElements);
    MACADAM_GL(PFNGLBINDBUFFERPROC, BindBuffer);
    MACADAM_GL(PFNGLBINDVERTEXARRAYPROC, BindVertexArray);
    MACADAM_GL(PFNGLBUFFERDATAPROC, BufferData);
    MACADAM_GL(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray);
    MACADAM_GL(PFNGLGENBUFFERSPROC, GenBuffers);
    MACADAM_GL(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays);
    MACADAM_GL(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer);
#undef MACADAM_GL

    void describe_vertices(std::size_t vertex_bytes, std::span<const VertexPart> parts) const;
    void number_corners() const;

    std::size_t quad_bytes;
};

void VertexBuffer::Gl::describe_vertices(std::size_t vertex_bytes,
                                         std::span<const VertexPart> parts) const {
    GLuint array = 0;
    GenVertexArrays(1, &array);
    BindVertexArray(array);
    GLuint vertices = 0;
    GenBuffers(1, &vertices);
    BindBuffer(GL_ARRAY_BUFFER, vertices);
    for (GLuint location = 0; const auto& part : parts) {
        EnableVertexAttribArray(location);
        VertexAttribPointer(location++,
                            part.count,
                            GL_FLOAT,
                            GL_FALSE,
                            GLsizei(vertex_bytes),
                            // OpenGL interprets the offset as an address.
                            reinterpret_cast<const void*>(part.offset)); // NOLINT
    }
}

void VertexBuffer::Gl::number_corners() const {
    std::vector<std::uint32_t> corners;
    corners.reserve(quads_per_call * indices_of_quad);
    for (std::uint32_t first = 0; first < quads_per_call * corners_of_quad;
         first += corners_of_quad) {
        for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) {
            corners.push_back(first + corner);
        }
    }
    GLuint buffer = 0;
    GenBuffers(1, &buffer);
    BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
    BufferData(GL_ELEMENT_ARRAY_BUFFER,
               GLsizeiptr(corners.size() * sizeof(corners[0])),
               corners.data(),
               GL_STATIC_DRAW);
}

VertexBuffer::VertexBuffer(const GlContext& context,
                           std::size_t vertex_bytes,
                           std::span<const VertexPart> parts)
    : gl_{std::make_unique<Gl>(context, vertex_bytes)} {
    gl_->describe_vertices(vertex_bytes, parts);
    gl_->number_corners();
}

VertexBuffer::~VertexBuffer() = default;

void VertexBuffer::draw_bytes(std::span<const std::byte> quads) const {
    assert(quads.size() % gl_->quad_bytes == 0);
    while (!quads.empty()) {
        const auto some = quads.first(std::min(quads.size(), quads_per_call * gl_->quad_bytes));
        gl_->BufferData(
            GL_ARRAY_BUFFER, GLsizeiptr(some.size_bytes()), some.data(), GL_STREAM_DRAW);
        gl_->DrawElements(GL_TRIANGLES,
                          GLsizei(some.size() / gl_->quad_bytes * indices_of_quad),
                          GL_UNSIGNED_INT,
                          nullptr);
        quads = quads.subspan(some.size());
    }
}

} // namespace macadam
