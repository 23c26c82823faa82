#pragma once

#include "render/gl/gl_context.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace macadam {

/// What a vertex has at a location of the shader.
struct VertexPart {
    enum class Kind {
        floats,
        shares ///< bytes that stand for 0 to 1
    } kind;
    int count;          ///< 1 .. 4
    std::size_t offset; ///< bytes from the vertex's begin
};

/// Draws rectangles of four corners each, in the order 0 1 2, 2 1 3, as many in one call as fit in
/// some megabytes. Binds a vertex array and buffers of its own, which stay bound.
class VertexBuffer {
public:
    /// \param parts  by location, from 0 on
    VertexBuffer(const GlContext& context,
                 std::size_t vertex_bytes,
                 std::span<const VertexPart> parts);
    ~VertexBuffer();

    /// \param Vertex  of vertex_bytes
    template <typename Vertex>
    void draw(std::span<const std::array<Vertex, 4>> quads) const {
        draw_bytes(std::as_bytes(quads));
    }

private:
    void draw_bytes(std::span<const std::byte> quads) const;

    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
