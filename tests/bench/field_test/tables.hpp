#pragma once

#include "methods.hpp"

#include <string>

namespace macadam::field_test {

/// The paper's table beside ours, and what each part of the error is, as Markdown.
std::string tables_of(const Fitted& test, double share);

/// Histograms of the errors by band, and estimate over reference, as SVG files of their own.
std::string histograms_svg(const Fitted& test);
std::string scatter_svg(const Fitted& test);

} // namespace macadam::field_test
