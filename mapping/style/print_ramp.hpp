#pragma once

#include <array>
#include <cstdint>

namespace macadam {

/// Colours from smooth to rough that also stay apart in shades of grey, as maps are printed: the
/// rougher, the darker.
///
/// Hues are those of ColorBrewer 2.0 by Cynthia A. Brewer, "YlOrRd", lightness falls in steps of 15
/// or more.
inline constexpr std::array<std::uint32_t, 5> print_ramp{
    0xffffcc, 0xfec44f, 0xf57f30, 0xd7301f, 0x7f0000};

} // namespace macadam
