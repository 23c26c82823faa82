#include "app/serve/filters/filter_operand.hpp"

#include "app/serve/filters/cql2_literals.hpp"
#include "storage/text/text.hpp"

namespace macadam {
namespace {

template <typename Value>
const Value* cell_as(const Cell& cell) {
    return std::get_if<Value>(&cell.value());
}

} // namespace

FilterOperand column_operand(const FeatureColumn& column) {
    using Kind = ColumnType::Kind;
    switch (column.type.kind) {
    case Kind::truth:
        return FilterTruth{[&column](const Feature& feature) -> std::optional<bool> {
            const auto cell = column.value(feature.row);
            const auto* const value = cell_as<bool>(cell);
            return value == nullptr ? std::nullopt : std::optional{*value};
        }};
    case Kind::integer:
    case Kind::real:
        return FilterNumber{[&column](const Feature& feature) -> std::optional<double> {
            const auto shown = plain_text(column.type, column.value(feature.row));
            return shown ? parse_number(*shown) : std::nullopt;
        }};
    case Kind::day:
        return FilterTime{[&column](const Feature& feature) -> std::optional<Cql2Span> {
            const auto day = plain_text(column.type, column.value(feature.row));
            if (!day) {
                return std::nullopt;
            }
            const auto instant = parse_cql2_instant(*day);
            return Cql2Span{instant, instant};
        }};
    default:
        return FilterText{[&column](const Feature& feature) {
            return plain_text(column.type, column.value(feature.row));
        }};
    }
}

} // namespace macadam
