#pragma once

#include "mapping/style/base_map.hpp"
#include "render/gl/gl_context.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

/// Lays pixels on a context's picture as they are. The memory behind it is the driver's while it
/// draws, so they go through OpenGL.
class PixelPainter {
public:
    explicit PixelPainter(const GlContext& context);
    ~PixelPainter();

    /// \param part  where on the context's picture
    /// \param rgba  its pixels, first row first
    ///
    /// They stay inside the box that was cleared last, as all that is drawn.
    void lay(const PicturePart& part, std::span<const std::uint8_t> rgba);

private:
    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
