#pragma once

#include <compare>
#include <string>

namespace macadam {

/// Where a font is read from.
struct FontSource {
    std::string file;
    long face = 0; ///< of a file that holds several
    friend auto operator<=>(const FontSource&, const FontSource&) = default;
};

} // namespace macadam
