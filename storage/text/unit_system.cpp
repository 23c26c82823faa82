#include "storage/text/unit_system.hpp"

#include "mapping/style/iri_class.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <set>
#include <utility>

namespace macadam {
namespace {

using Kind = ColumnType::Kind;

struct Conversion {
    std::string_view unit;
    std::string_view suffix; ///< of a column's name
    std::string_view us_unit;
    std::string_view us_suffix;
    double factor;
    int fewer_decimals; ///< in files
};

constexpr std::array conversions{
    Conversion{"mm/m", "", "in/mi", "_in_per_mi", in_per_mi_of_mm_per_m, 2},
    Conversion{"m", "_m", "ft", "_ft", ft_of_m, 0},
    Conversion{"km", "_km", "mi", "_mi", 1000 * mi_of_m, 0},
    Conversion{"mm", "_mm", "in", "_in", in_of_mm, -2},
    Conversion{"m/s", "_mps", "mph", "_mph", 3600 * mi_of_m, 0},
    Conversion{"km/h", "_kmh", "mph", "_mph", 1000 * mi_of_m, 0}};

/// Words of headings of tables, longest first.
constexpr std::array headings{std::pair{std::string_view{"metres"}, std::string_view{"feet"}},
                              std::pair{std::string_view{"mm/m"}, std::string_view{"in/mi"}},
                              std::pair{std::string_view{"km/h"}, std::string_view{"mph"}},
                              std::pair{std::string_view{"km"}, std::string_view{"mi"}},
                              std::pair{std::string_view{"mm"}, std::string_view{"in"}},
                              std::pair{std::string_view{" m"}, std::string_view{" ft"}}};

/// Returns a text that lives as long as the program: names of columns are views.
std::string_view interned(const std::string& text) {
    static std::mutex mutex;
    static std::set<std::string> texts;
    const std::lock_guard lock{mutex};
    return *texts.insert(text).first;
}

std::string name_in_us(std::string_view name, const Conversion& conversion) {
    if (name.empty()) {
        return {};
    }
    if (name == conversion.unit) { // "km"
        return std::string{conversion.us_unit};
    }
    if (constexpr std::string_view of_iri = "_mm_per_m"; name.ends_with(of_iri)) {
        return fmt::format(
            "{}{}", name.substr(0, name.size() - of_iri.size()), conversion.us_suffix);
    }
    if (!name.ends_with(conversion.suffix)) {
        return fmt::format("{}{}", name, conversion.us_suffix);
    }
    return fmt::format(
        "{}{}", name.substr(0, name.size() - conversion.suffix.size()), conversion.us_suffix);
}

std::string heading_in_us(std::string_view heading) {
    for (const auto& [metric, us] : headings) {
        if (const auto at = heading.find(metric); at != std::string_view::npos) {
            return fmt::format(
                "{}{}{}", heading.substr(0, at), us, heading.substr(at + metric.size()));
        }
    }
    return std::string{heading};
}

bool is_digit(char c) {
    return '0' <= c && c <= '9';
}

/// Scales the numbers with a decimal point within a text, and keeps the width of each if it can.
std::string scaled_numbers(std::string_view text, double factor, int fewer_decimals) {
    std::string scaled;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && is_digit(text[end])) {
            ++end;
        }
        const bool is_decimal =
            end > i && end + 1 < text.size() && text[end] == '.' && is_digit(text[end + 1]);
        if (!is_decimal) {
            const auto next = std::max(end, i + 1);
            scaled += text.substr(i, next - i);
            i = next;
            continue;
        }
        const auto point = end;
        for (++end; end < text.size() && is_digit(text[end]);) {
            ++end;
        }
        const double value = std::strtod(std::string{text.substr(i, end - i)}.c_str(), nullptr);
        const int decimals =
            std::max(0, static_cast<int>(end - point) - 1 - std::max(0, fewer_decimals));
        scaled += fmt::format("{:>{}.{}f}", value * factor, end - i, decimals);
        i = end;
    }
    return scaled;
}

} // namespace

std::string length_words(double length_m, UnitSystem units) {
    return units == UnitSystem::us ? fmt::format("{:.0f} ft", length_m * ft_of_m)
                                   : fmt::format("{:g} m", length_m);
}

std::string iri_words(double mm_per_m, UnitSystem units) {
    return units == UnitSystem::us ? fmt::format("{:.0f} in/mi", mm_per_m * in_per_mi_of_mm_per_m)
                                   : fmt::format("{:.2f} mm/m", mm_per_m);
}

std::string km_words(double km, int decimals, UnitSystem units) {
    return units == UnitSystem::us ? fmt::format("{:.{}f} mi", 1000 * km * mi_of_m, decimals)
                                   : fmt::format("{:.{}f} km", km, decimals);
}

IriScale iri_scale(int decimals, UnitSystem units) {
    return units == UnitSystem::us ? IriScale{in_per_mi_of_mm_per_m, std::max(0, decimals - 2)}
                                   : IriScale{1, decimals};
}

UsColumn us_column(std::string_view name, const ColumnType& type, const ShownColumn& shown) {
    UsColumn us{name, type, shown.heading, shown.decimals};
    const auto* const found = std::ranges::find(conversions, type.unit, &Conversion::unit);
    if (type.unit.empty() || found == conversions.end()) {
        return us;
    }
    us.factor = found->factor;
    const bool is_number = type.kind == Kind::real || type.kind == Kind::integer;
    const bool says_unit = is_number || name.ends_with(found->suffix); // not a list of several
    us.name = says_unit ? interned(name_in_us(name, *found)) : name;
    us.heading = interned(heading_in_us(shown.heading));
    us.type.unit = found->us_unit;
    if (is_number) {
        us.type.kind = Kind::real;
        us.type.decimals = type.decimals == ColumnType::shortest
                               ? ColumnType::shortest
                               : std::max(0, type.decimals - found->fewer_decimals);
    }
    if (shown.decimals) {
        us.decimals = std::max(0, *shown.decimals - std::max(0, found->fewer_decimals));
    }
    return us;
}

Cell in_us_units(const Cell& cell, const UsColumn& column) {
    const auto& value = cell.value();
    if (const auto* const real = std::get_if<double>(&value)) {
        return *real * column.factor;
    }
    if (const auto* const count = std::get_if<std::int64_t>(&value)) {
        return static_cast<double>(*count) * column.factor;
    }
    if (const auto* const text = std::get_if<std::string>(&value)) {
        auto scaled = scaled_numbers(*text, column.factor, column.type.unit == "in/mi" ? 2 : 0);
        constexpr std::string_view key = "_m\":"; // of JSON
        for (auto at = scaled.find(key); at != std::string::npos; at = scaled.find(key)) {
            scaled.replace(at, key.size(), "_ft\":");
        }
        return scaled;
    }
    return cell;
}

} // namespace macadam
