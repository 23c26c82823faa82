#include "app/profile/spectra_figure.hpp"

namespace macadam {

ChartPanel
spectra_panel(const std::string& title, const std::string& unit, const ChannelSpectra& spectra) {
    using enum ChartLine::Look;
    const auto& hz = spectra.measured.hz;
    return {.title = title,
            .x_label = "frequency, Hz",
            .y_label = "amplitude, " + unit + " per √Hz",
            .lines = {{"model, before the fit", hz, spectra.before, faint},
                      {"measured", hz, spectra.measured.amplitude, solid},
                      {"model, fitted", hz, spectra.after, dashed}}};
}

} // namespace macadam
