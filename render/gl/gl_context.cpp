#include "render/gl/gl_context.hpp"

#include "estimator/common/error.hpp"
#include "render/gl/gl_library.hpp"

#include <fmt/core.h>

#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <string_view>

#include <sys/mman.h>

namespace macadam {
namespace {

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

/// Opens the library that draws, and tells whether it is OSMesa.
bool open_library() {
    // Mesa would write compiled shaders to the user's home from another thread; these shaders
    // compile in a few milliseconds. Pictures shall not depend on a graphics card.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    setenv("LIBGL_ALWAYS_SOFTWARE", "true", 1);
    const char* const value = std::getenv("MACADAM_OPENGL"); // NOLINT(concurrency-mt-unsafe)
    const std::string_view wanted = value == nullptr ? "" : value;
    if (!wanted.empty() && wanted != "osmesa" && wanted != "egl") {
        throw InputError{fmt::format("MACADAM_OPENGL is '{}', expected osmesa or egl", wanted)};
    }
    if (wanted == "osmesa" || (wanted.empty() && has_osmesa())) {
        open_osmesa();
        return true;
    }
    open_egl();
    return false;
}

} // namespace

GlContext::GlContext(std::span<std::uint8_t> rgba, int width_px, int height_px) {
    check_size(width_px, height_px);
    assert(rgba.size() == std::size_t(width_px) * std::size_t(height_px) * 4);
    const bool by_osmesa = open_library();
    expect_memory(width_px, height_px);
    const GlPixels pixels{rgba, width_px, height_px};
    context_ = by_osmesa ? osmesa_context(pixels) : egl_context(pixels);
    context_->make_current();
}

GlContext::~GlContext() = default;

void GlContext::make_current() const {
    context_->make_current();
}

void GlContext::finish() const {
    context_->finish();
}

GlContext::Address GlContext::address(const char* name) const {
    return context_->address(name);
}

} // namespace macadam
