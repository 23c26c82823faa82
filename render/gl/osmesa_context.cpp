#include "render/gl/gl_library.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"

#include <GL/gl.h>
#include <fmt/core.h>

#include <array>
#include <cstdlib>

namespace macadam {
namespace {

constexpr const char* library = "libOSMesa.so.8";

// As in Mesa's GL/osmesa.h, which ends with version 25.0.
constexpr int osmesa_format = 0x22;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_context_major_version = 0x36;
constexpr int osmesa_context_minor_version = 0x37;
using CreateContext = void*(const int* attributes, void* shared);
using DestroyContext = void(void* context);
using MakeCurrent = GLboolean(void* context, void* pixels, GLenum type, int width, int height);
using GetCurrentContext = void*();
using GetProcAddress = GlLibraryContext::Address(const char* name);

template <typename Function>
Function* mesa(const char* name) {
    return plugin_function<Function>(library, name);
}

class OsmesaContext final : public GlLibraryContext {
public:
    explicit OsmesaContext(const GlPixels& pixels) : pixels_{pixels} {
        constexpr std::array attributes{osmesa_format,
                                        GL_RGBA,
                                        osmesa_profile,
                                        osmesa_core_profile,
                                        osmesa_context_major_version,
                                        3,
                                        osmesa_context_minor_version,
                                        3,
                                        0};
        context_ = mesa<CreateContext>("OSMesaCreateContextAttribs")(attributes.data(), nullptr);
        if (context_ == nullptr) {
            throw InputError{fmt::format("'{}' gives no OpenGL 3.3 core context", library)};
        }
    }

    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;
    ~OsmesaContext() override { mesa<DestroyContext>("OSMesaDestroyContext")(context_); }

    void make_current() const override {
        if (mesa<GetCurrentContext>("OSMesaGetCurrentContext")() == context_) {
            return;
        }
        const auto made = mesa<MakeCurrent>("OSMesaMakeCurrent")(
            context_, pixels_.rgba.data(), GL_UNSIGNED_BYTE, pixels_.width_px, pixels_.height_px);
        if (made != GL_TRUE) {
            throw InputError{fmt::format("'{}' cannot draw a picture of {}x{} px",
                                         library,
                                         pixels_.width_px,
                                         pixels_.height_px)};
        }
    }

    Address address(const char* name) const override {
        const auto found = mesa<GetProcAddress>("OSMesaGetProcAddress")(name);
        if (found == nullptr) {
            throw InputError{fmt::format("'{}' has no function '{}'", library, name)};
        }
        return found;
    }

    void finish() const override {
        // NOLINTNEXTLINE(*-reinterpret-cast)
        reinterpret_cast<decltype(&glFinish)>(address("glFinish"))();
    }

private:
    GlPixels pixels_;
    void* context_ = nullptr;
};

} // namespace

void open_osmesa() {
    mesa<CreateContext>("OSMesaCreateContextAttribs");
}

bool has_osmesa() {
    static const bool has = [] {
        try {
            open_osmesa();
            return true;
        } catch (const InputError&) {
            return false;
        }
    }();
    return has;
}

std::unique_ptr<GlLibraryContext> osmesa_context(const GlPixels& pixels) {
    return std::make_unique<OsmesaContext>(pixels);
}

} // namespace macadam
