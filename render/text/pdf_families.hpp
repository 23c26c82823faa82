#pragma once

#include <string>

namespace macadam {

/// Returns the font families of a text for Pango, the first choice first: Noto's for each script.
/// Han characters take the shapes of the country whose letters are beside them, and by default
/// those of China, as on pictures.
std::string pdf_families_for(const std::string& utf8);

} // namespace macadam
