#include "render/gl/gl_library.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"

#define EGL_NO_X11 // keeps the headers of X11 out
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/core.h>

#include <array>

namespace macadam {
namespace {

constexpr const char* library = "libEGL.so.1";
constexpr const char* needed = "libOSMesa.so.8 (Debian: libosmesa6), or libEGL.so.1 and Mesa's "
                               "software rasteriser (Debian: libegl1, libgl1-mesa-dri)";

template <typename Function>
Function* egl(const char* name) {
    return plugin_function<Function>(library, name);
}

/// Opens the display without a screen once; the library keeps it until the process ends.
EGLDisplay opened_display() {
    static const EGLDisplay display = [] {
        EGLDisplay made = EGL_NO_DISPLAY;
        try {
            made = egl<decltype(eglGetPlatformDisplay)>("eglGetPlatformDisplay")(
                EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        } catch (const InputError& error) {
            throw InputError{fmt::format("{}; pictures need {}", error.what(), needed)};
        }
        if (made == EGL_NO_DISPLAY ||
            egl<decltype(eglInitialize)>("eglInitialize")(made, nullptr, nullptr) != EGL_TRUE) {
            throw InputError{fmt::format(
                "'{}' cannot draw without a screen; pictures need {}", library, needed)};
        }
        return made;
    }();
    return display;
}

class EglContext final : public GlLibraryContext {
public:
    explicit EglContext(const GlPixels& pixels) : pixels_{pixels}, display_{opened_display()} {
        constexpr std::array config_attributes{
            EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        constexpr std::array attributes{EGL_CONTEXT_MAJOR_VERSION,
                                        3,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        const bool is_chosen =
            egl<decltype(eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API) == EGL_TRUE &&
            egl<decltype(eglChooseConfig)>("eglChooseConfig")(
                display_, config_attributes.data(), &config, 1, &count) == EGL_TRUE &&
            count == 1;
        context_ = is_chosen ? egl<decltype(eglCreateContext)>("eglCreateContext")(
                                   display_, config, EGL_NO_CONTEXT, attributes.data())
                             : EGL_NO_CONTEXT;
        if (context_ == EGL_NO_CONTEXT) {
            throw InputError{fmt::format(
                "'{}' gives no OpenGL 3.3 core context; pictures need {}", library, needed)};
        }
        try {
            make_current();
            create_framebuffer();
        } catch (...) {
            destroy();
            throw;
        }
    }

    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;
    ~EglContext() override { destroy(); }

    void make_current() const override {
        if (current() == context_) {
            return;
        }
        egl<decltype(eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API); // is one of each thread
        if (egl<decltype(eglMakeCurrent)>("eglMakeCurrent")(
                display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
            throw InputError{fmt::format("'{}' cannot draw a picture of {}x{} px",
                                         library,
                                         pixels_.width_px,
                                         pixels_.height_px)};
        }
    }

    Address address(const char* name) const override {
        const auto found = egl<decltype(eglGetProcAddress)>("eglGetProcAddress")(name);
        if (found == nullptr) {
            throw InputError{fmt::format("'{}' has no function '{}'", library, name)};
        }
        return found;
    }

    void finish() const override {
        entry<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer")(GL_READ_FRAMEBUFFER, framebuffer_);
        entry<decltype(&glReadPixels)>("glReadPixels")(0,
                                                       0,
                                                       pixels_.width_px,
                                                       pixels_.height_px,
                                                       GL_RGBA,
                                                       GL_UNSIGNED_BYTE,
                                                       pixels_.rgba.data());
    }

private:
    template <typename Pointer>
    Pointer entry(const char* name) const {
        return reinterpret_cast<Pointer>(address(name)); // NOLINT(*-reinterpret-cast)
    }

    static EGLContext current() {
        return egl<decltype(eglGetCurrentContext)>("eglGetCurrentContext")();
    }

    /// Creates what is drawn into; it is freed with the context.
    void create_framebuffer() {
        GLuint colours = 0;
        entry<PFNGLGENRENDERBUFFERSPROC>("glGenRenderbuffers")(1, &colours);
        entry<PFNGLBINDRENDERBUFFERPROC>("glBindRenderbuffer")(GL_RENDERBUFFER, colours);
        entry<PFNGLRENDERBUFFERSTORAGEPROC>("glRenderbufferStorage")(
            GL_RENDERBUFFER, GL_RGBA8, pixels_.width_px, pixels_.height_px);
        entry<PFNGLGENFRAMEBUFFERSPROC>("glGenFramebuffers")(1, &framebuffer_);
        entry<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer")(GL_FRAMEBUFFER, framebuffer_);
        entry<PFNGLFRAMEBUFFERRENDERBUFFERPROC>("glFramebufferRenderbuffer")(
            GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colours);
        const auto status =
            entry<PFNGLCHECKFRAMEBUFFERSTATUSPROC>("glCheckFramebufferStatus")(GL_FRAMEBUFFER);
        if (status != GL_FRAMEBUFFER_COMPLETE) {
            throw InputError{fmt::format("'{}' cannot draw a picture of {}x{} px",
                                         library,
                                         pixels_.width_px,
                                         pixels_.height_px)};
        }
    }

    void destroy() {
        if (current() == context_) { // or it would live on with the thread
            egl<decltype(eglMakeCurrent)>("eglMakeCurrent")(
                display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        egl<decltype(eglDestroyContext)>("eglDestroyContext")(display_, context_);
    }

    GlPixels pixels_;
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
    GLuint framebuffer_ = 0;
};

} // namespace

void open_egl() {
    opened_display();
}

std::unique_ptr<GlLibraryContext> egl_context(const GlPixels& pixels) {
    return std::make_unique<EglContext>(pixels);
}

} // namespace macadam
