#include "render/gl/gl_context.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"

#include <GL/osmesa.h>
#include <fmt/core.h>

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdlib>

#include <sys/mman.h>

namespace macadam {
namespace {

constexpr const char* library = "libOSMesa.so.8";

template <typename Function>
Function* mesa(const char* name) {
    return plugin_function<Function>(library, name);
}

void check_size(int width_px, int height_px) {
    for (const int side_px : {width_px, height_px}) {
        if (side_px < 1 || side_px > max_window_px) {
            throw InputError{fmt::format(
                "'{}x{}', expected sides of 1 to {} px", width_px, height_px, max_window_px)};
        }
    }
}

/// Checks that enough memory is available, since Mesa and its compiler crash if an allocation
/// fails. The requirement is the measured one plus half.
void expect_memory(int width_px, int height_px) {
    constexpr std::size_t own_bytes = 100'000'000;
    constexpr std::size_t bytes_per_px = 12;
    const auto bytes =
        own_bytes + bytes_per_px * static_cast<std::size_t>(width_px) * std::size_t(height_px);
    void* const tried =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (tried == MAP_FAILED) {
        constexpr double megabyte = 1e6;
        throw InputError{fmt::format("not enough memory to draw {} x {} pixels, expected {:.0f} MB "
                                     "more",
                                     width_px,
                                     height_px,
                                     static_cast<double>(bytes) / megabyte)};
    }
    ::munmap(tried, bytes);
}

void* new_context() {
    // Mesa would write compiled shaders to the user's home from another thread; these shaders
    // compile in a few milliseconds.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    constexpr std::array attributes{OSMESA_FORMAT,
                                    OSMESA_RGBA,
                                    OSMESA_PROFILE,
                                    OSMESA_CORE_PROFILE,
                                    OSMESA_CONTEXT_MAJOR_VERSION,
                                    3,
                                    OSMESA_CONTEXT_MINOR_VERSION,
                                    3,
                                    0};
    return mesa<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")(
        attributes.data(), nullptr);
}

void destroy(void* context) {
    mesa<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext")(
        static_cast<OSMesaContext>(context));
}

} // namespace

GlContext::GlContext(std::span<std::uint8_t> rgba, int width_px, int height_px)
    : context_{nullptr}, rgba_{rgba}, width_px_{width_px}, height_px_{height_px} {
    check_size(width_px, height_px);
    assert(rgba.size() == std::size_t(width_px) * std::size_t(height_px) * 4);

    mesa<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs"); // opens the library
    expect_memory(width_px, height_px);
    context_ = new_context();
    if (context_ == nullptr) {
        throw InputError{fmt::format("'{}' gives no OpenGL 3.3 core context", library)};
    }
    try {
        make_current();
    } catch (...) {
        destroy(context_);
        throw;
    }
}

void GlContext::make_current() const {
    if (mesa<decltype(OSMesaGetCurrentContext)>("OSMesaGetCurrentContext")() == context_) {
        return;
    }
    const auto made =
        mesa<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent")(static_cast<OSMesaContext>(context_),
                                                               rgba_.data(),
                                                               GL_UNSIGNED_BYTE,
                                                               width_px_,
                                                               height_px_);
    if (made != GL_TRUE) {
        throw InputError{
            fmt::format("'{}' cannot draw a picture of {}x{} px", library, width_px_, height_px_)};
    }
}

GlContext::~GlContext() {
    destroy(context_);
}

GlContext::Address GlContext::address(const char* name) const {
    const auto found = mesa<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress")(name);
    if (found == nullptr) {
        throw InputError{fmt::format("'{}' has no function '{}'", library, name)};
    }
    return found;
}

} // namespace macadam
