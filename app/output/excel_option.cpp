#include "app/output/excel_option.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace macadam {

std::optional<ExcelDialect> parse_excel(const Arguments& arguments) {
    const auto given = arguments.value("--excel");
    if (!given) {
        return std::nullopt;
    }
    if (given->empty()) {
        try {
            return excel_dialect(numeric_locale());
        } catch (const std::invalid_argument&) {
            return ExcelDialect{}; // a language of which we know nothing
        }
    }
    try {
        return excel_dialect(*given);
    } catch (const std::invalid_argument& error) {
        throw UsageError{fmt::format("--excel is '{}', {}", *given, error.what())};
    }
}

} // namespace macadam
