#include "tables.hpp"

#include "render/report/document/line_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam::field_test {
namespace {

struct Shown {
    std::size_t row;
    ChartLine::Look look;
};
constexpr std::array shown{Shown{methods.size() - 1, ChartLine::Look::solid},
                           Shown{0, ChartLine::Look::dashed},
                           Shown{1, ChartLine::Look::faint}};

/// Share of the errors in each of even bins, drawn as steps.
ChartLine steps_of(const std::string& name, const std::vector<double>& errors, double reach) {
    constexpr std::size_t bins = 40;
    std::array<double, bins> share{};
    for (const double error : errors) {
        const double bin = (error + reach) / (2 * reach) * bins;
        if (bin >= 0 && bin < bins) {
            share[static_cast<std::size_t>(bin)] += 100 / static_cast<double>(errors.size());
        }
    }
    ChartLine line{.name = name, .x = {}, .y = {}};
    for (std::size_t bin = 0; bin < bins; ++bin) {
        for (const std::size_t side : {bin, bin + 1}) {
            line.x.push_back(reach * (2 * static_cast<double>(side) / bins - 1));
            line.y.push_back(share[bin]);
        }
    }
    return line;
}

constexpr double plot = 300; // of one scatter, in the figure's units
constexpr double pitch = 350;
constexpr double left = 56;
constexpr double top = 40;
constexpr double max_mm_per_m = 12;

std::string scatter_frame(double at_x, const char* title) {
    std::string svg =
        fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" "
                    "stroke=\"#888\"/>\n<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n"
                    "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#888\"/>\n"
                    "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">reference IRI, mm/m</text>\n",
                    at_x,
                    top,
                    plot,
                    plot,
                    at_x,
                    top - 12,
                    title,
                    at_x,
                    top + plot,
                    at_x + plot,
                    top,
                    at_x + plot / 2,
                    top + plot + 42);
    for (int tick = 0; tick <= 12; tick += 2) {
        const double along = plot * tick / max_mm_per_m;
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
                           "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                           at_x + along,
                           top + plot + 20,
                           tick,
                           at_x - 6,
                           top + plot - along + 5,
                           tick);
    }
    return svg;
}

} // namespace

std::string histograms_svg(const Fitted& test) {
    std::vector<ChartPanel> panels;
    for (std::size_t band = 0; band < bands.size(); ++band) {
        ChartPanel panel{.title = fmt::format("Reference IRI {:g} to {:g} mm/m",
                                              bands[band].from_mm_per_m,
                                              bands[band].to_mm_per_m),
                         .x_label = "estimate minus reference, mm/m",
                         .y_label = "% of pieces",
                         .lines = {}};
        const double reach = 1.0 + static_cast<double>(band);
        for (const auto& [row, look] : shown) {
            std::vector<double> errors;
            for (const auto& reading : test.readings) {
                if (band_of(reading.reference) == band) {
                    errors.push_back(reading.estimate[row] - reading.reference);
                }
            }
            auto line = steps_of(methods[row].name, errors, reach);
            line.look = look;
            panel.lines.push_back(std::move(line));
        }
        panels.push_back(std::move(panel));
    }
    return line_charts_svg(panels);
}

std::string scatter_svg(const Fitted& test) {
    constexpr std::size_t max_dots = 1500; // a picture must stay small
    std::string svg =
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" "
                    "font-family=\"sans-serif\" "
                    "font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
                    "<text x=\"16\" y=\"{}\" text-anchor=\"middle\" transform=\"rotate(-90 16 "
                    "{})\">estimate, mm/m</text>\n",
                    left + pitch * static_cast<double>(shown.size()),
                    top + plot + 56,
                    top + plot / 2,
                    top + plot / 2);
    const std::size_t every = std::max<std::size_t>(1, test.readings.size() / max_dots);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double at_x = left + pitch * static_cast<double>(i);
        svg += scatter_frame(at_x, methods[shown[i].row].name);
        svg += "<g fill=\"#0a5fb4\" fill-opacity=\"0.5\">\n";
        for (std::size_t n = 0; n < test.readings.size(); n += every) {
            const auto& reading = test.readings[n];
            const double y = reading.estimate[shown[i].row];
            if (std::max(y, reading.reference) < max_mm_per_m) {
                svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.6\"/>\n",
                                   at_x + plot * reading.reference / max_mm_per_m,
                                   top + plot - plot * y / max_mm_per_m);
            }
        }
        svg += "</g>\n";
    }
    return svg + "</svg>\n";
}

} // namespace macadam::field_test
