#pragma once

#include <compare>
#include <string>

namespace macadam {

/// File of a font.
struct FontSource {
    std::string file;
    long face = 0; ///< index in a file with several faces
    friend auto operator<=>(const FontSource&, const FontSource&) = default;
};

} // namespace macadam
