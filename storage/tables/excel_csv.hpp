#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Dialect of CSV that Excel opens with a double click: it takes separator and decimal mark from
/// the country of its user.
struct ExcelDialect {
    char separator = ',';
    char decimal_mark = '.';
};

/// Returns the dialect of a locale such as "de", "en", "fr_CH.UTF-8" or "C".
/// \throws std::invalid_argument  for a language that is not known; it names those that are.
ExcelDialect excel_dialect(std::string_view locale);

/// Returns the locale of numbers of this process: LC_ALL, LC_NUMERIC or LANG; "C" if none is set.
std::string numeric_locale();

/// Turns CSV as columns.hpp writes it into CSV for Excel: begins with a byte order mark, and
/// replaces separators and the decimal marks of numbers. Takes the text in any pieces.
class ExcelCsv {
public:
    explicit ExcelCsv(ExcelDialect dialect) : dialect_{dialect} {}

    std::string operator()(std::string_view csv);

private:
    std::string finished_cell();

    ExcelDialect dialect_;
    std::string cell_{};
    bool is_quoted_ = false; ///< within quotes
    bool has_begun_ = false;
};

} // namespace macadam
