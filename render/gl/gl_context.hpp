#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

class GlLibraryContext;

inline constexpr int max_window_px = 16384; ///< limit of Mesa; larger sizes fail silently

/// OpenGL 3.3 core context without a window, drawing into memory. It is current in the thread that
/// created it until it is destroyed or another context becomes current.
///
/// It is one of OSMesa, or of EGL where OSMesa cannot be opened; the variable MACADAM_OPENGL
/// (osmesa, egl) decides otherwise. The library is loaded with the first context, and every entry
/// point is looked up in it by name: a program that also links libGL would otherwise call the
/// functions of that library, which draw into no context.
class GlContext {
public:
    /// \param rgba  width_px * height_px * 4 bytes, which must outlive the context; its first row
    ///              is the bottom row of OpenGL's window.
    /// \throws InputError  if a side is not 1 .. max_window_px (OSMesa accepts larger sizes and
    ///                     then draws wrongly or crashes), or if the library is missing or fails.
    GlContext(std::span<std::uint8_t> rgba, int width_px, int height_px);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// Makes this the current context of the thread.
    void make_current() const;

    /// Waits until all that was drawn is in the memory.
    void finish() const;

    /// Looks up an OpenGL function: `context.entry<decltype(&glClear)>("glClear")`.
    template <typename Pointer>
    Pointer entry(const char* name) const {
        return reinterpret_cast<Pointer>(address(name)); // NOLINT(*-reinterpret-cast)
    }

private:
    using Address = void (*)();
    Address address(const char* name) const;

    std::unique_ptr<GlLibraryContext> context_;
};

} // namespace macadam
