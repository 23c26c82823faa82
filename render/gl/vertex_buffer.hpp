#pragma once

#include "render/gl/gl_context.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace macadam {

/// Vertex attribute at a location of the shader.
struct VertexPart {
    int count;          ///< of floats, 1 .. 4
    std::size_t offset; ///< bytes from the beginning of the vertex
};

/// Draws quads with corners in the order 0 1 2, 2 1 3, in batches of some megabytes. It binds its
/// own vertex array and buffers, which stay bound.
class VertexBuffer {
public:
    /// \param parts  by location, starting at 0
    VertexBuffer(const GlContext& context,
                 std::size_t vertex_bytes,
                 std::span<const VertexPart> parts);
    ~VertexBuffer();

    /// \param Vertex  type of size vertex_bytes
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
