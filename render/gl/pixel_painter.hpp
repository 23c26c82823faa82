#pragma once

#include "mapping/style/base_map.hpp"
#include "render/gl/gl_context.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

/// Copies pixels unchanged to a context's picture. Its memory belongs to the driver while drawing,
/// so they are copied through OpenGL.
class PixelPainter {
public:
    explicit PixelPainter(const GlContext& context);
    ~PixelPainter();

    /// \param part  position on the context's picture
    /// \param rgba  its pixels, first row first
    ///
    /// They are clipped to the box that was cleared last, like all drawing.
    void lay(const PicturePart& part, std::span<const std::uint8_t> rgba);

private:
    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
