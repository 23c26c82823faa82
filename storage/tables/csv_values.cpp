#include "storage/tables/csv_values.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr double max_mm_per_m = 1000; // rougher than any passable road

} // namespace

std::optional<bool> direction_in(const CsvRow& row) {
    const auto text = row.text("direction");
    if (text.empty()) {
        return std::nullopt;
    }
    if (text != "forward" && text != "backward") {
        throw InputError{fmt::format("{}: direction is {}, expected forward, backward or empty",
                                     row.where(),
                                     in_quotes(text))};
    }
    return text == "forward";
}

std::optional<double> iri_in(const CsvRow& row, std::string_view column, double mm_per_m_of_one) {
    const auto value = row.number(column, 0, max_mm_per_m / mm_per_m_of_one, "an IRI, or empty");
    return value ? std::optional{*value * mm_per_m_of_one} : std::nullopt;
}

} // namespace macadam
