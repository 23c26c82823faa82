#pragma once

#include "app/serve/features/feature.hpp"
#include "app/serve/filters/cql2_expression.hpp"
#include "app/serve/filters/cql2_times.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace macadam {

// Operands of filters: functions of a feature, by the type of their values.

/// Value of a feature; `std::nullopt` if it is unknown.
template <typename Value>
using ValueOf = std::function<std::optional<Value>(const Feature&)>;

using FilterTruth = ValueOf<bool>;
using FilterNumber = ValueOf<double>;
using FilterText = ValueOf<std::string>;
using FilterTime = ValueOf<Cql2Span>;
struct FilterPlace {
    const Cql2Geometry* literal; ///< null: the feature's geometry
};
using FilterOperand = std::variant<FilterTruth, FilterNumber, FilterText, FilterTime, FilterPlace>;

inline constexpr std::array<std::string_view, 5> filter_operand_names{
    "a truth value", "a number", "a text", "a time", "a geometry"};

template <typename Value>
ValueOf<Value> constant(Value value) {
    return [value = std::optional{std::move(value)}](const Feature&) { return value; };
}

/// Function of two values, unknown if one of them is.
template <typename Result, typename Value, typename Function>
ValueOf<Result> of_both(ValueOf<Value> a, ValueOf<Value> b, Function function) {
    return [a = std::move(a), b = std::move(b), function](
               const Feature& feature) -> std::optional<Result> {
        const auto left = a(feature);
        if (!left) {
            return std::nullopt;
        }
        const auto right = b(feature);
        return right ? function(*left, *right) : std::nullopt;
    };
}

/// Operand of the values that a client sees of a column, which must outlive it.
FilterOperand column_operand(const FeatureColumn& column);

} // namespace macadam
