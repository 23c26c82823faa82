#include "render/gl/pixel_painter.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

#include <cassert>

namespace macadam {

struct PixelPainter::Gl {
    explicit Gl(const GlContext& context) : context_{context} {}

#define MACADAM_GL(type, name) type name = context_.entry<type>("gl" #name)
    const GlContext& context_;
    MACADAM_GL(decltype(&glBindTexture), BindTexture);
    MACADAM_GL(decltype(&glGenTextures), GenTextures);
    MACADAM_GL(decltype(&glTexImage2D), TexImage2D);
    MACADAM_GL(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer);
    MACADAM_GL(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer);
    MACADAM_GL(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D);
    MACADAM_GL(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers);
#undef MACADAM_GL

    GLuint texture = 0;
    GLuint framebuffer = 0;
};

PixelPainter::PixelPainter(const GlContext& context) : gl_{std::make_unique<Gl>(context)} {
    gl_->GenTextures(1, &gl_->texture); // freed with the context
    gl_->GenFramebuffers(1, &gl_->framebuffer);
}

PixelPainter::~PixelPainter() = default;

void PixelPainter::lay(const PicturePart& part, std::span<const std::uint8_t> rgba) {
    assert(rgba.size() == std::size_t(part.width_px) * std::size_t(part.height_px) * 4);
    gl_->BindTexture(GL_TEXTURE_2D, gl_->texture);
    gl_->TexImage2D(GL_TEXTURE_2D,
                    0,
                    GL_RGBA8,
                    part.width_px,
                    part.height_px,
                    0,
                    GL_RGBA,
                    GL_UNSIGNED_BYTE,
                    rgba.data());
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, gl_->framebuffer);
    gl_->FramebufferTexture2D(
        GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, gl_->texture, 0);
    gl_->BlitFramebuffer(0,
                         0,
                         part.width_px,
                         part.height_px,
                         part.left_px,
                         part.top_px,
                         part.left_px + part.width_px,
                         part.top_px + part.height_px,
                         GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

} // namespace macadam
