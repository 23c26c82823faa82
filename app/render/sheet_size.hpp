#pragma once

#include "app/cli/arguments.hpp"
#include "render/scene/scene.hpp"

#include <optional>
#include <string>

namespace macadam {

/// Parses the size of a picture: pixels, millimetres or a paper of --size, with --dpi.
/// \throws UsageError  for any other text, and for sides that pictures do not have.
PictureSize picture_size(const Arguments& arguments);

/// Parses the size of a .pdf's sheet: --paper, or millimetres or a paper of --size.
/// \throws UsageError  likewise.
PictureSize pdf_size(const Arguments& arguments);

/// Parses --scale, "25000" or "1:25000".
/// \throws UsageError  for any other text, and for scales that maps do not have.
std::optional<double> parse_scale(const Arguments& arguments);

/// Tells whether a text is the name of a paper, such as A4.
bool is_paper(const std::string& text);

} // namespace macadam
