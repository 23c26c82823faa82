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

std::string
row_of(const char* name, const Spread& ours, const Spread* paper, const std::string& more) {
    const auto numbers = [](const Spread& s) {
        return fmt::format("{:+.2f} | {:.2f} | {:.2f}", s.mean, s.sd, s.rmse);
    };
    return fmt::format(
        "| {} | {} | {} | {} |\n", name, numbers(ours), paper ? numbers(*paper) : " | | ", more);
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

std::string results_of(const std::vector<Reading>& readings) {
    std::string text;
    for (std::size_t band = 0; band <= bands.size(); ++band) {
        const auto floor =
            spread_of(readings, band, [](const Reading& r) { return r.matched - r.reference; });
        text += fmt::format("\n**IRI {} mm/m, {:.1f} km**\n\n",
                            name_of(band),
                            segment_m * static_cast<double>(floor.count) / 1000);
        text += "| method | mean | std dev | RMSE | paper: mean | std dev | RMSE | RMSE of the "
                "method alone |\n"
                "|---|---|---|---|---|---|---|---|\n";
        for (std::size_t row = 0; row < methods.size(); ++row) {
            const auto ours = spread_of(
                readings, band, [=](const Reading& r) { return r.estimate[row] - r.reference; });
            const auto alone = spread_of(
                readings, band, [=](const Reading& r) { return r.at_true_place[row] - r.driven; });
            text += row_of(methods[row].name,
                           ours,
                           row < 2 ? &published[row][band] : nullptr,
                           fmt::format("{:.2f}", alone.rmse));
        }
        text += row_of("a method without error", floor, nullptr, "0");
    }
    return text;
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
    std::string text = fmt::format("{} pieces of {:g} m, {:.1f} km{}; errors are estimate minus "
                                   "reference in mm/m.\n",
                                   test.readings.size(),
                                   segment_m,
                                   segment_m * static_cast<double>(test.readings.size()) / 1000,
                                   share < 1 ? fmt::format(" ({:g} of the paper's)", share) : "");
    text += "\n## Beside the paper\n" + results_of(test.readings);
    text += "\n## What the world adds to every method (RMSE, mm/m)\n" + sources_of(test.readings);
    text += "\n## Factors and intervals\n\n| method | factor fitted | 90 % interval covers "
            "|\n|---|---|---|\n";
    for (std::size_t row = 0; row < methods.size(); ++row) {
        text += fmt::format("| {} | {} | {:.0f} % |\n",
                            methods[row].name,
                            methods[row].fitted ? fmt::format("{:.2f}", test.factor[row]) : "none",
                            100 * covered(test.readings, row));
    }
    return text;
}

} // namespace macadam::field_test
