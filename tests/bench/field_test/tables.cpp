#include "tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

namespace macadam::field_test {
namespace {

constexpr double z_of_90_percent = 1.645;

struct Spread {
    double mean = 0, sd = 0, rmse = 0;
    std::size_t count = 0;
};

using Value = std::function<double(const Reading&)>;

/// Of error(reading) over the readings of a band; all bands: bands.size().
Spread spread_of(const std::vector<Reading>& readings, std::size_t band, const Value& error) {
    Spread spread;
    double square = 0;
    for (const auto& reading : readings) {
        if (band == bands.size() || band_of(reading.reference) == band) {
            spread.mean += error(reading);
            square += error(reading) * error(reading);
            ++spread.count;
        }
    }
    const auto n = static_cast<double>(spread.count);
    spread.mean /= n;
    spread.rmse = std::sqrt(square / n);
    spread.sd = std::sqrt(std::max(0.0, square / n - spread.mean * spread.mean));
    return spread;
}

/// Table IV of the paper: vertical, lateral; bands, then all of them.
constexpr Spread published[2][bands.size() + 1] = {{{0.01, 0.25, 0.25},
                                                    {0.02, 0.46, 0.46},
                                                    {-0.13, 0.66, 0.68},
                                                    {-0.38, 1.24, 1.29},
                                                    {0.00, 0.37, 0.37}},
                                                   {{0.20, 0.46, 0.50},
                                                    {0.31, 0.92, 0.97},
                                                    {-0.09, 1.41, 1.41},
                                                    {-1.98, 1.84, 2.70},
                                                    {0.17, 0.74, 0.76}}};

std::string name_of(std::size_t band) {
    return band < bands.size()
               ? fmt::format("{:g} to {:g}", bands[band].from_mm_per_m, bands[band].to_mm_per_m)
               : fmt::format("{:g} to {:g}", bands.front().from_mm_per_m, bands.back().to_mm_per_m);
}

std::string mean_sd_rmse(const Spread& s) {
    return fmt::format("{:+.2f}, {:.2f}, {:.2f}", s.mean, s.sd, s.rmse);
}

/// Errors of a method, with the place that satellites give.
Spread errors_of(const std::vector<Reading>& readings, std::size_t band, std::size_t row) {
    return spread_of(
        readings, band, [=](const Reading& r) { return r.estimate[row] - r.reference; });
}

double covered(const std::vector<Reading>& readings, std::size_t row) {
    std::size_t inside = 0;
    for (const auto& reading : readings) {
        inside += std::abs(reading.at_true_place[row] - reading.driven) <=
                          z_of_90_percent * reading.sd[row]
                      ? 1U
                      : 0U;
    }
    return static_cast<double>(inside) / static_cast<double>(readings.size());
}

/// Errors of the published filter by band, beside those of the paper.
std::string paper_table(const std::vector<Reading>& readings) {
    std::string text = "| IRI | km | kf, vertical | paper | kf, lateral | paper |\n"
                       "|---|---|---|---|---|---|\n";
    for (std::size_t band = 0; band <= bands.size(); ++band) {
        const auto vertical = errors_of(readings, band, 0);
        text += fmt::format("| {} | {:.1f} | {} | {} | {} | {} |\n",
                            name_of(band),
                            segment_m * static_cast<double>(vertical.count) / 1000,
                            mean_sd_rmse(vertical),
                            mean_sd_rmse(published[0][band]),
                            mean_sd_rmse(errors_of(readings, band, 1)),
                            mean_sd_rmse(published[1][band]));
    }
    return text;
}

/// A row of mean and RMSE by band, and two more cells.
std::string method_row(const std::string& name,
                       const std::function<Spread(std::size_t band)>& errors,
                       const std::string& factor,
                       const std::string& coverage) {
    std::string text = fmt::format("| {} |", name);
    for (std::size_t band = 0; band <= bands.size(); ++band) {
        const auto spread = errors(band);
        text += fmt::format(" {:+.2f}, {:.2f} |", spread.mean, spread.rmse);
    }
    return text + fmt::format(" {} | {} |\n", factor, coverage);
}

std::string method_table(const Fitted& test) {
    std::string text = "| method |";
    std::string line = "|---|";
    for (std::size_t band = 0; band <= bands.size(); ++band) {
        text += fmt::format(" {} |", name_of(band));
        line += "---|";
    }
    text += " factor fitted | 90 % interval covers, % |\n" + line + "---|---|\n";
    for (std::size_t row = 0; row < methods.size(); ++row) {
        text += method_row(
            methods[row].name,
            [&](std::size_t band) { return errors_of(test.readings, band, row); },
            methods[row].fitted ? fmt::format("{:.2f}", test.factor[row]) : "",
            fmt::format("{:.0f}", 100 * covered(test.readings, row)));
    }
    const auto floor = [&](std::size_t band) {
        return spread_of(
            test.readings, band, [](const Reading& r) { return r.matched - r.reference; });
    };
    return text + method_row("a method without error", floor, "", "");
}

std::string sources_of(const std::vector<Reading>& readings) {
    std::string text =
        "\n| IRI | satellites: place along the road | wheel paths of the two cars | both |\n"
        "|---|---|---|---|\n";
    for (std::size_t band = 0; band <= bands.size(); ++band) {
        const auto of = [&](const Value& error) { return spread_of(readings, band, error).rmse; };
        text += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} |\n",
                            name_of(band),
                            of([](const Reading& r) { return r.matched - r.driven; }),
                            of([](const Reading& r) { return r.driven - r.reference; }),
                            of([](const Reading& r) { return r.matched - r.reference; }));
    }
    return text;
}

} // namespace

std::string tables_of(const Fitted& test, double share) {
    std::string text = fmt::format("{} intervals of {:g} m, {:.1f} km{}; errors are estimate minus "
                                   "reference in mm/m.\n",
                                   test.readings.size(),
                                   segment_m,
                                   segment_m * static_cast<double>(test.readings.size()) / 1000,
                                   share < 1 ? fmt::format(" ({:g} of the paper's)", share) : "");
    text +=
        "\n## Beside the paper: mean, standard deviation, RMSE\n\n" + paper_table(test.readings);
    text += "\n## All methods: mean, RMSE\n\n" + method_table(test);
    text += "\n## What the world adds to every method (RMSE, mm/m)\n" + sources_of(test.readings);
    return text;
}

} // namespace macadam::field_test
