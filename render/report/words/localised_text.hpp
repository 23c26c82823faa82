#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/style/iri_class.hpp"
#include "render/report/words/messages.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace macadam {

/// Unit of roughness, which stands for a system of units: in_per_mi has miles, feet and inches.
enum class IriUnit { mm_per_m, in_per_mi };

/// Formatting of words, numbers, days and roughness in a report. Input values are mm/m in every
/// unit.
struct Localisation {
    const Language* language = &english();
    IriUnit unit = IriUnit::mm_per_m;

    std::string operator()(std::string_view key, const Values& values = {}) const;

    /// Returns the message with that key, or the given text, for names that come from data.
    std::string or_else(const std::string& key, std::string_view text) const;

    /// Returns the message in the plural form of the number, which is its {count}.
    std::string counted(std::string_view key, std::size_t count, Values values = {}) const;

    std::string number(double value, int decimals) const;
    std::string signed_number(double value, int decimals) const;
    std::string whole(double value) const;    ///< "240"
    std::string shortest(double value) const; ///< "20", "2.5": up to six digits
    std::string
    count(std::size_t count) const; ///< thousands separated by narrow spaces from 10 000 on

    /// Formats a length of road in km or mi with the decimals that suit the longest of them: 2
    /// below 10 km, 1 below 1000 km, then none.
    std::string road_length(double length_m, double longest_m) const;

    double long_length(double length_m) const;       ///< in km or mi
    std::string short_length(double length_m) const; ///< whole m or ft
    std::string small_size(double size_mm) const;    ///< whole mm, or hundredths of an inch
    std::string long_unit() const;                   ///< "km"

    /// Returns "34.1 %"; "0 %" only for exactly 0, "< 0.1 %" for very small parts. A dash if
    /// `whole` is 0.
    std::string percent(double part, double whole) const;

    /// Returns "34 %"; with the decimals of percent() below 1 %.
    std::string whole_percent(double part, double whole) const;

    std::string day(std::string_view iso) const; ///< from "2026-03-01"
    std::string period(std::string_view first_day,
                       std::string_view last_day) const; ///< "" = no days

    std::string iri(double mm_per_m) const;        ///< "2.41", or "153" in in/mi
    std::string iri_change(double mm_per_m) const; ///< "+0.52", "+33"
    std::string_view iri_unit() const;             ///< "mm/m"
    std::string iri_with_unit(double mm_per_m) const;
    std::string interval(double low, double high) const; ///< "2.11 – 2.71"
    std::string interval(const RoadMean& mean) const;    ///< 90 %
    std::string change_interval(double low, double high) const;
    std::string range(const ClassTable& table,
                      std::size_t i) const; ///< "below 1.50", "1.50 – 2.68"
};

/// Converts mm/m to the unit.
double in_unit(double mm_per_m, IriUnit unit);

} // namespace macadam
