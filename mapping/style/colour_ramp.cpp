#include "mapping/style/colour_ramp.hpp"

#include <array>

namespace macadam {
namespace {

// ColorBrewer 2.0 by Cynthia A. Brewer, "RdYlBu", 5 and 3 classes from the blue end; the ramp of 3
// uses the ends of 5, which are stronger, and a yellow that is visible on white.
constexpr std::array<std::uint32_t, 5> rdylbu{0x2c7bb6, 0xabd9e9, 0xffffbf, 0xfdae61, 0xd7191c};
constexpr std::array<std::uint32_t, 3> rdylbu_of_3{0x2c7bb6, 0xfee090, 0xd7191c};

// Matplotlib's colour maps at 0, 1/4, 1/2, 3/4 and 1. viridis: S. van der Walt and N. Smith (2015);
// cividis: J. R. Nunez, C. R. Anderton, R. S. Renslow, PLoS ONE 13(7): e0199239 (2018).
constexpr std::array<std::uint32_t, 5> viridis{0x440154, 0x3b528b, 0x21918c, 0x5ec962, 0xfde725};
constexpr std::array<std::uint32_t, 5> cividis{0x00224e, 0x434e6c, 0x7d7c78, 0xbcae6c, 0xfee838};

constexpr std::array ramps{ColourRamp{"rdylbu", rdylbu, rdylbu_of_3},
                           ColourRamp{"cividis", cividis, cividis},
                           ColourRamp{"viridis", viridis, viridis}};

} // namespace

std::span<const ColourRamp> colour_ramps() {
    return ramps;
}

} // namespace macadam
