#include "app/output/excel_option.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace macadam {

std::optional<CsvDialect> parse_excel(const Arguments& arguments) {
    const auto given = arguments.value("--excel");
    if (!given) {
        return std::nullopt;
    }
    if (given->empty()) {
        try {
            return csv_dialect(numeric_locale());
        } catch (const std::invalid_argument&) {
            return CsvDialect{}; // a language of which we know nothing
        }
    }
    try {
        return csv_dialect(*given);
    } catch (const std::invalid_argument& error) {
        throw UsageError{fmt::format("--excel is '{}', {}", *given, error.what())};
    }
}

} // namespace macadam
