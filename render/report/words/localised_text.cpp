#include "render/report/words/localised_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr std::string_view dash = "–";
constexpr std::string_view minus = "\u2212";

/// Returns the number of decimals of roughness: a hundredth of a mm/m is about half an in/mi.
int iri_decimals(IriUnit unit) {
    return unit == IriUnit::mm_per_m ? 2 : 0;
}

constexpr double m_per_mi = 1609.344, m_per_ft = 0.3048, mm_per_in = 25.4;

/// Adds the values of placeholders for units: words, and round lengths and speeds of the method.
Values with_units(const Localisation& say, Values values) {
    const bool us = say.unit == IriUnit::in_per_mi;
    const auto word = [&](std::string_view name) {
        return say.or_else(fmt::format("unit.{}.{}", name, us ? "us" : "si"), "");
    };
    values.insert(values.end(),
                  {{"long_unit", us ? "mi" : "km"},
                   {"short_unit", us ? "ft" : "m"},
                   {"small_unit", us ? "in" : "mm"},
                   {"20_m", us ? "66 ft" : "20 m"},
                   {"100_m", us ? "328 ft" : "100 m"},
                   {"100_m_of", us ? "328\u00A0ft" : "100\u00A0m"},
                   {"80_kmh", us ? "50 mph" : "80 km/h"},
                   {"18_kmh", us ? "11 mph" : "18 km/h"},
                   {"one_long", word("one_long")},
                   {"long_plural", word("long_plural")},
                   {"short_plural", word("short_plural")}});
    return values;
}

} // namespace

double in_unit(double mm_per_m, IriUnit unit) {
    return unit == IriUnit::mm_per_m ? mm_per_m : mm_per_m * in_per_mi_of_mm_per_m;
}

std::string Localisation::operator()(std::string_view key, const Values& values) const {
    return say(*language, key, with_units(*this, values));
}

std::string Localisation::or_else(const std::string& key, std::string_view text) const {
    const auto* const message = find_message(*language, key);
    return std::string{message != nullptr ? *message : text};
}

std::string Localisation::counted(std::string_view key, std::size_t number, Values values) const {
    values.emplace_back("count", count(number));
    return say(*language, key, with_units(*this, std::move(values)), number);
}

std::string Localisation::number(double value, int decimals) const {
    auto text = fmt::format("{:.{}f}", value, decimals);
    if (const auto point = text.find('.'); point != std::string::npos) {
        text.replace(point, 1, *find_message(*language, "locale.decimal_mark"));
    }
    return text;
}

std::string Localisation::signed_number(double value, int decimals) const {
    // A value that rounds to zero has no sign.
    const bool nothing = std::abs(value) < 0.5 * std::pow(10.0, -decimals);
    return fmt::format("{}{}",
                       nothing     ? "±"
                       : value < 0 ? minus
                                   : "+",
                       number(std::abs(nothing ? 0 : value), decimals));
}

std::string Localisation::whole(double value) const {
    return fmt::format("{:.0f}", value);
}

std::string Localisation::shortest(double value) const {
    auto text = fmt::format("{:g}", value);
    if (const auto point = text.find('.'); point != std::string::npos) {
        text.replace(point, 1, *find_message(*language, "locale.decimal_mark"));
    }
    return text;
}

std::string Localisation::count(std::size_t count) const {
    auto text = fmt::format("{}", count);
    const auto& mark = *find_message(*language, "locale.group_mark");
    if (text.size() >= 5) {
        for (auto i = static_cast<std::ptrdiff_t>(text.size()) - 3; i > 0; i -= 3) {
            text.insert(static_cast<std::size_t>(i), mark);
        }
    }
    return text;
}

double Localisation::long_length(double length_m) const {
    return length_m / (unit == IriUnit::in_per_mi ? m_per_mi : 1000);
}

std::string Localisation::road_length(double length_m, double longest_m) const {
    const double longest = long_length(longest_m);
    const int decimals = longest < 10 ? 2 : longest < 1000 ? 1 : 0;
    return number(long_length(length_m), decimals);
}

std::string Localisation::short_length(double length_m) const {
    return whole(length_m / (unit == IriUnit::in_per_mi ? m_per_ft : 1));
}

std::string Localisation::small_size(double size_mm) const {
    return unit == IriUnit::in_per_mi ? number(size_mm / mm_per_in, 2) : whole(size_mm);
}

std::string Localisation::long_unit() const {
    return unit == IriUnit::in_per_mi ? "mi" : "km";
}

std::string Localisation::percent(double part, double whole) const {
    if (whole <= 0) {
        return std::string{dash};
    }
    const double percent = 100 * part / whole;
    const auto said = [&](const std::string& value) {
        return say(*language, "locale.percent", {{"number", value}});
    };
    return percent <= 0    ? said("0")
           : percent < 0.1 ? "< " + said(number(0.1, 1))
                           : said(number(percent, 1));
}

std::string Localisation::whole_percent(double part, double whole_part) const {
    const double percents = whole_part > 0 ? 100 * part / whole_part : 0;
    return percents < 1 ? percent(part, whole_part)
                        : say(*language, "locale.percent", {{"number", whole(percents)}});
}

std::string Localisation::day(std::string_view iso) const {
    constexpr std::size_t iso_letters = 10;
    if (iso.size() != iso_letters) {
        return std::string{iso};
    }
    return say(*language,
               "locale.day",
               {{"year", std::string{iso.substr(0, 4)}},
                {"month", std::string{iso.substr(5, 2)}},
                {"day", std::string{iso.substr(8, 2)}}});
}

std::string Localisation::period(std::string_view first_day, std::string_view last_day) const {
    return first_day.empty() ? ""
           : first_day == last_day
               ? day(first_day)
               : (*this)("period", {{"first", day(first_day)}, {"last", day(last_day)}});
}

std::string Localisation::iri(double mm_per_m) const {
    return number(in_unit(mm_per_m, unit), iri_decimals(unit));
}

std::string Localisation::iri_change(double mm_per_m) const {
    return signed_number(in_unit(mm_per_m, unit), iri_decimals(unit));
}

std::string_view Localisation::iri_unit() const {
    return unit == IriUnit::mm_per_m ? "mm/m" : "in/mi";
}

std::string Localisation::iri_with_unit(double mm_per_m) const {
    return fmt::format("{} {}", iri(mm_per_m), iri_unit());
}

std::string Localisation::interval(double low, double high) const {
    return fmt::format("{} {} {}", iri(low), dash, iri(high));
}

std::string Localisation::interval(const RoadMean& mean) const {
    return interval(mean.low, mean.high);
}

std::string Localisation::change_interval(double low, double high) const {
    return (*this)("range.change", {{"from", iri_change(low)}, {"to", iri_change(high)}});
}

std::string Localisation::range(const ClassTable& table, std::size_t i) const {
    const auto border = [&](std::size_t row) { return iri(table.classes[row].to_mm_per_m); };
    const bool last = std::isinf(table.classes[i].to_mm_per_m);
    if (i == 0) {
        return last ? (*this)("range.all")
                    : (*this)(table.classes[i].open ? "range.below" : "range.up_to",
                              {{"to", border(i)}});
    }
    if (last) {
        return (*this)(table.classes[i - 1].open ? "range.from" : "range.above",
                       {{"from", border(i - 1)}});
    }
    return fmt::format("{} {} {}", border(i - 1), dash, border(i));
}

} // namespace macadam
