#include "render/report/numbers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

constexpr const char* narrow_blank = "&#8239;";
constexpr const char* dash = "–";

} // namespace

std::string count_text(std::size_t count) {
    auto text = fmt::format("{}", count);
    if (text.size() >= 5) {
        for (auto i = static_cast<std::ptrdiff_t>(text.size()) - 3; i > 0; i -= 3) {
            text.insert(static_cast<std::size_t>(i), narrow_blank);
        }
    }
    return text;
}

std::string km_text(double length_m, double longest_m) {
    const int decimals = longest_m < 10e3 ? 2 : longest_m < 1000e3 ? 1 : 0;
    return fmt::format("{:.{}f}", length_m / 1000, decimals);
}

std::string percent_text(double part, double whole) {
    if (whole <= 0) {
        return dash;
    }
    const double percent = 100 * part / whole;
    if (percent <= 0) {
        return "0 %";
    }
    return percent < 0.1 ? "&lt; 0.1 %" : fmt::format("{:.1f} %", percent);
}

std::string iri_text(double iri_mm_per_m) {
    return fmt::format("{:.2f}", iri_mm_per_m);
}

std::string interval_text(const RoadMean& mean) {
    return fmt::format("{:.2f} {} {:.2f}", mean.low, dash, mean.high);
}

std::string range_text(const ClassTable& table, std::size_t i, bool in_per_mi) {
    const auto number = [&](std::size_t row) {
        const double border = table.classes[row].to_mm_per_m;
        return in_per_mi ? fmt::format("{:.0f}", border * in_per_mi_of_mm_per_m)
                         : fmt::format("{:.2f}", border);
    };
    const bool last = std::isinf(table.classes[i].to_mm_per_m);
    if (i == 0) {
        return last ? "all" : (table.classes[i].open ? "below " : "up to ") + number(i);
    }
    if (last) {
        return (table.classes[i - 1].open ? "from " : "above ") + number(i - 1);
    }
    return fmt::format("{} {} {}", number(i - 1), dash, number(i));
}

} // namespace macadam
