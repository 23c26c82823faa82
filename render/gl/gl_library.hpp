#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

/// Memory that a context draws into: rows of width_px pixels of 4 bytes, the bottom row of OpenGL's
/// window first.
struct GlPixels {
    std::span<std::uint8_t> rgba;
    int width_px;
    int height_px;
};

/// OpenGL 3.3 core context of one library, drawing without a window.
class GlLibraryContext {
public:
    using Address = void (*)();

    GlLibraryContext() = default;
    GlLibraryContext(const GlLibraryContext&) = delete;
    GlLibraryContext& operator=(const GlLibraryContext&) = delete;
    virtual ~GlLibraryContext() = default;

    /// Makes this the current context of the thread.
    /// \throws InputError  if the library refuses.
    virtual void make_current() const = 0;

    /// Looks up an OpenGL function of the current context.
    /// \throws InputError  if there is none of this name.
    virtual Address address(const char* name) const = 0;

    /// Waits until all is drawn and in the memory.
    virtual void finish() const = 0;
};

/// Tests whether OSMesa can be opened. Mesa has it up to version 25.0, that of Debian 13.
bool has_osmesa();

/// Opens OSMesa.
/// \throws InputError  if it is missing.
void open_osmesa();

/// Opens EGL and its display without a screen, on Mesa's software rasteriser.
/// \throws InputError  if either is missing.
void open_egl();

/// Creates a context of OSMesa, which draws into the memory itself.
/// \throws InputError  if the library is missing or fails.
std::unique_ptr<GlLibraryContext> osmesa_context(const GlPixels& pixels);

/// Creates a context of EGL without a surface. It draws into a framebuffer object, which finish()
/// copies to the memory.
/// \throws InputError  if the library is missing or fails.
std::unique_ptr<GlLibraryContext> egl_context(const GlPixels& pixels);

} // namespace macadam
