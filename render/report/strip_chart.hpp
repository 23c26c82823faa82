#pragma once

#include "render/report/document/document.hpp"
#include "render/report/report.hpp"

namespace macadam {

/// Size of a strip chart, in units of a drawing.
struct StripSize {
    double width;
    double row_height; ///< of one direction
};
inline constexpr StripSize strip_on_card{400, 110};
inline constexpr StripSize strip_on_page{840, 130};

/// Draws roughness by chainage: a column in the colour of its class for each piece, its 90 %
/// interval as a translucent band, the border of poor as a dashed line, junctions above, control
/// and reference sections below. Directions lie one below the other on one scale.
///
/// \param words  text alternative
document::Drawing
strip_drawing(const Report& report, const Strip& strip, StripSize size, const std::string& words);

} // namespace macadam
