#pragma once

#include <cstdint>
#include <span>

namespace macadam {

inline constexpr int max_window_px = 16384; ///< what OSMesa can draw; more silently fails

/// An OpenGL 3.3 core context without a window, drawing into memory. It is current in the thread
/// that made it until it ends or another one is.
///
/// OSMesa is opened when the first context is made, and every entry point comes from it by name: a
/// program that links libGL as well would call that one's functions, which draw nothing.
class GlContext {
public:
    /// \param rgba  width_px * height_px * 4 bytes, to live longer than the context; its first
    ///              row is the one at the bottom of OpenGL's window.
    /// \throws InputError  if a side is not 1 .. max_window_px (OSMesa accepts more and then draws
    ///                     wrongly or crashes), or if OSMesa is missing or refuses.
    GlContext(std::span<std::uint8_t> rgba, int width_px, int height_px);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// What is drawn from now on in this thread is drawn here.
    void make_current() const;

    /// An OpenGL function: `context.entry<decltype(&glClear)>("glClear")`.
    template <typename Pointer>
    Pointer entry(const char* name) const {
        return reinterpret_cast<Pointer>(address(name)); // NOLINT(*-reinterpret-cast)
    }

private:
    using Address = void (*)();
    Address address(const char* name) const;

    void* context_;
    std::span<std::uint8_t> rgba_;
    int width_px_, height_px_;
};

} // namespace macadam
