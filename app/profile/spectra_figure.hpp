#pragma once

#include "estimator/identification/spectrum_fit.hpp"
#include "render/report/document/line_chart.hpp"

#include <string>

namespace macadam {

/// Builds the chart of a channel's spectra.
///
/// \param unit  of the amplitude's signal: "m/s²"
ChartPanel
spectra_panel(const std::string& title, const std::string& unit, const ChannelSpectra& spectra);

} // namespace macadam
