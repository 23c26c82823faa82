#include "app/serve/filters/feature_filter.hpp"

#include "app/serve/filters/cql2_like.hpp"
#include "app/serve/filters/cql2_literals.hpp"
#include "app/serve/filters/cql2_times.hpp"
#include "app/serve/filters/filter_operand.hpp"
#include "app/serve/filters/geometry_relation.hpp"
#include "storage/text/case_folding.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace macadam {
namespace {

using Truth = FilterTruth;
using Number = FilterNumber;
using Text = FilterText;
using Time = FilterTime;
using Place = FilterPlace;
using Operand = FilterOperand;

/// Makes operands of expressions over columns.
class Compiler {
public:
    Compiler(std::span<const FeatureColumn> columns, CoordinateReference crs)
        : columns_{columns}, crs_{crs} {}

    Truth truth(const Cql2Expression& expression) const {
        return as<Truth>(operand(expression), "a condition");
    }

private:
    template <typename Wanted>
    static Wanted as(Operand operand, std::string_view expected) {
        if (auto* const found = std::get_if<Wanted>(&operand)) {
            return std::move(*found);
        }
        throw Cql2Error{fmt::format(
            "there is {}, expected {}", filter_operand_names.at(operand.index()), expected)};
    }

    Operand property(const std::string& name) const {
        if (name == geometry_property) {
            return Place{nullptr};
        }
        const auto column = std::ranges::find(columns_, name, &FeatureColumn::name);
        if (column == columns_.end() || !is_queryable(*column)) {
            throw Cql2Error{fmt::format("there is no property {}", in_quotes(name))};
        }
        return column_operand(*column);
    }

    Operand operand(const Cql2Expression& expression) const {
        const auto& op = expression.op;
        if (op.empty()) {
            return literal(expression.literal);
        }
        if (op == "and" || op == "or" || op == "not") {
            return logical(expression);
        }
        if (op == "between" || op == "in" || op == "isNull" || op == "like") {
            return predicate(expression);
        }
        if (op == "casei") {
            return Text{[text = text(expression.args.at(0))](const Feature& feature) {
                const auto value = text(feature);
                return value ? std::optional{case_folded(*value)} : std::nullopt;
            }};
        }
        if (op.starts_with("s_")) {
            return spatial(expression);
        }
        if (const auto relation = time_relation(op)) {
            expect_two(expression);
            return of_both<bool>(time(expression.args[0]),
                                 time(expression.args[1]),
                                 [relation](const Cql2Span& a, const Cql2Span& b) {
                                     return std::optional{relation(a, b)};
                                 });
        }
        return op.find_first_of("<>=") != std::string::npos
                   ? Operand{comparison(op, expression.args.at(0), expression.args.at(1))}
                   : Operand{arithmetic(expression)};
    }

    static void expect_two(const Cql2Expression& expression) {
        if (expression.args.size() != 2) {
            throw Cql2Error{
                fmt::format("{} takes 2 operands, not {}", expression.op, expression.args.size())};
        }
    }

    // ------------------------------------------------------------------------ literals, types

    Operand literal(const Cql2Expression::Literal& value) const {
        struct {
            const Compiler& compiler;
            Operand operator()(bool truth) const { return constant(truth); }
            Operand operator()(double number) const { return constant(number); }
            Operand operator()(const std::string& text) const { return constant(text); }
            Operand operator()(const Cql2Property& property) const {
                return compiler.property(property.name);
            }
            Operand operator()(const Cql2Instant& instant) const {
                return constant(Cql2Span{instant, instant});
            }
            Operand operator()(const Cql2Interval& interval) const {
                return compiler.interval(interval);
            }
            Operand operator()(const Cql2Geometry& geometry) const { return Place{&geometry}; }
        } const visitor{*this};
        return std::visit(visitor, value);
    }

    /// End of an interval; null for an open one.
    Time border(const Cql2Border& border) const {
        if (const auto* const instant = std::get_if<Cql2Instant>(&border)) {
            return constant(Cql2Span{*instant, *instant});
        }
        const auto* const name = std::get_if<Cql2Property>(&border);
        return name == nullptr ? nullptr : as<Time>(property(name->name), "a time");
    }

    Time interval(const Cql2Interval& ends) const {
        return [begin = border(ends.begin),
                end = border(ends.end)](const Feature& feature) -> std::optional<Cql2Span> {
            Cql2Span span;
            if (begin) {
                const auto value = begin(feature);
                if (!value) {
                    return std::nullopt;
                }
                span.begin = value->begin;
            }
            if (end) {
                const auto value = end(feature);
                if (!value) {
                    return std::nullopt;
                }
                span.end = value->end;
            }
            return span;
        };
    }

    Number number(const Cql2Expression& expression) const {
        return as<Number>(operand(expression), "a number");
    }

    Text text(const Cql2Expression& expression) const {
        return as<Text>(operand(expression), "a text");
    }

    /// Time, also from a text in quotes.
    Time time(const Cql2Expression& expression) const {
        const auto* const text = std::get_if<std::string>(&expression.literal);
        if (expression.op.empty() && text != nullptr) {
            const auto instant = parse_cql2_instant(*text);
            return constant(Cql2Span{instant, instant});
        }
        return as<Time>(operand(expression), "a time");
    }

    // ---------------------------------------------------------------------------- conditions

    Truth logical(const Cql2Expression& expression) const {
        std::vector<Truth> conditions;
        for (const auto& arg : expression.args) {
            conditions.push_back(truth(arg));
        }
        if (expression.op == "not") {
            return [condition = std::move(conditions.at(0))](const Feature& feature) {
                const auto value = condition(feature);
                return value ? std::optional{!*value} : std::nullopt;
            };
        }
        return any_equals(std::move(conditions), expression.op == "or");
    }

    /// Condition that has the value `decides` as soon as one of several has.
    static Truth any_equals(std::vector<Truth> conditions, bool decides) {
        return [conditions = std::move(conditions),
                decides](const Feature& feature) -> std::optional<bool> {
            bool is_known = true;
            for (const auto& condition : conditions) {
                const auto value = condition(feature);
                if (value == decides) {
                    return decides;
                }
                is_known = is_known && value.has_value();
            }
            return is_known ? std::optional{!decides} : std::nullopt;
        };
    }

    Truth predicate(const Cql2Expression& expression) const {
        const auto& args = expression.args;
        if (expression.op == "between") {
            return compared(args.at(0), {{">=", &args.at(1)}, {"<=", &args.at(2)}}, false);
        }
        if (expression.op == "in") {
            std::vector<Comparand> values;
            for (const auto& value : args.at(1).args) {
                values.push_back({"=", &value});
            }
            return compared(args.at(0), values, true);
        }
        if (expression.op == "like") {
            return of_both<bool>(text(args.at(0)),
                                 text(args.at(1)),
                                 [](const std::string& value, const std::string& pattern) {
                                     return std::optional{is_like(value, pattern)};
                                 });
        }
        return std::visit(
            [](const auto& value) -> Truth {
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Place>) {
                    return [is_of_feature = value.literal == nullptr](const Feature& feature) {
                        return std::optional{is_of_feature && feature.line.empty()};
                    };
                } else {
                    return [value](const Feature& feature) {
                        return std::optional{!value(feature).has_value()};
                    };
                }
            },
            operand(args.at(0)));
    }

    struct Comparand {
        std::string_view op;
        const Cql2Expression* value;
    };

    /// Compares one value with several, until one comparison is `decides`. The value is made and
    /// computed once for all: else lists in one another would multiply their lengths.
    Truth compared(const Cql2Expression& expression,
                   const std::vector<Comparand>& others,
                   bool decides) const {
        return std::visit(
            [&](auto value) -> Truth {
                if constexpr (std::is_same_v<decltype(value), Place>) {
                    throw Cql2Error{"a geometry cannot be compared"};
                } else {
                    using Result = decltype(value(std::declval<const Feature&>()));
                    const auto latest = std::make_shared<Result>(); // filters are for one thread
                    std::vector<Truth> conditions;
                    for (const auto& [op, other] : others) {
                        conditions.push_back(comparison(
                            op,
                            expression,
                            decltype(value){[latest](const Feature&) { return *latest; }},
                            *other));
                    }
                    return [value = std::move(value),
                            latest,
                            condition = any_equals(std::move(conditions), decides)](
                               const Feature& feature) {
                        *latest = value(feature);
                        return condition(feature);
                    };
                }
            },
            operand(expression));
    }

    template <typename Value>
    static Truth ordered(std::string_view op, ValueOf<Value> a, ValueOf<Value> b) {
        const auto test = [is_less = op.find('<') != std::string_view::npos,
                           is_more = op.find('>') != std::string_view::npos,
                           is_equal = op.find('=') !=
                                      std::string_view::npos](std::partial_ordering order) {
            return std::optional{(is_less && order < 0) || (is_more && order > 0) ||
                                 (is_equal && order == 0)};
        };
        return of_both<bool>(std::move(a), std::move(b), [test](const Value& x, const Value& y) {
            if constexpr (std::is_same_v<Value, Cql2Span>) {
                return test(compare(*x.begin, *y.begin));
            } else {
                return test(x <=> y);
            }
        });
    }

    Truth
    comparison(std::string_view op, const Cql2Expression& left, const Cql2Expression& right) const {
        return comparison(op, left, operand(left), right);
    }

    /// \param a  operand of `left`
    Truth comparison(std::string_view op,
                     const Cql2Expression& left,
                     Operand a,
                     const Cql2Expression& right) const {
        auto b = operand(right);
        if (std::holds_alternative<Time>(a) || std::holds_alternative<Time>(b)) {
            for (const auto* each : {&left, &right}) {
                if (std::holds_alternative<Cql2Interval>(each->literal)) {
                    throw Cql2Error{"intervals are compared by functions such as T_INTERSECTS"};
                }
            }
            return ordered(op, time(left), time(right));
        }
        if (a.index() != b.index() || std::holds_alternative<Place>(a)) {
            throw Cql2Error{fmt::format("{} cannot be compared with {}",
                                        filter_operand_names.at(a.index()),
                                        filter_operand_names.at(b.index()))};
        }
        if (auto* const numbers = std::get_if<Number>(&a)) {
            return ordered(op, std::move(*numbers), std::get<Number>(std::move(b)));
        }
        if (auto* const texts = std::get_if<Text>(&a)) {
            return ordered(op, std::move(*texts), std::get<Text>(std::move(b)));
        }
        return ordered(op, std::get<Truth>(std::move(a)), std::get<Truth>(std::move(b)));
    }

    Number arithmetic(const Cql2Expression& expression) const {
        expect_two(expression);
        const auto known = [](double value) {
            return std::isfinite(value) ? std::optional{value} : std::nullopt;
        };
        const auto made = [&](auto function) {
            return of_both<double>(
                number(expression.args[0]),
                number(expression.args[1]),
                [known, function](double a, double b) { return known(function(a, b)); });
        };
        const auto& op = expression.op;
        return op == "+"   ? made([](double a, double b) { return a + b; })
               : op == "-" ? made([](double a, double b) { return a - b; })
               : op == "*" ? made([](double a, double b) { return a * b; })
               : op == "/" ? made([](double a, double b) { return a / b; })
               : op == "%" ? made([](double a, double b) { return std::fmod(a, b); })
               : op == "^" ? made([](double a, double b) { return std::pow(a, b); })
                           : made([](double a, double b) { return std::trunc(a / b); });
    }

    Truth spatial(const Cql2Expression& expression) const {
        expect_two(expression);
        const auto a = as<Place>(operand(expression.args[0]), "a geometry");
        const auto b = as<Place>(operand(expression.args[1]), "a geometry");
        const auto relation =
            std::make_shared<const GeometryRelation>(expression.op, a.literal, b.literal, crs_);
        return [relation, is_of_feature = a.literal == nullptr || b.literal == nullptr](
                   const Feature& feature) -> std::optional<bool> {
            return is_of_feature && feature.line.empty() ? std::nullopt
                                                         : std::optional{relation->holds(feature)};
        };
    }

    std::span<const FeatureColumn> columns_;
    CoordinateReference crs_;
};

/// Box of the spatial functions that must hold for the whole expression to hold.
std::optional<GeoBox> box_of(const Cql2Expression& expression, CoordinateReference crs) {
    if (expression.op == "and") {
        for (const auto& arg : expression.args) {
            if (const auto box = box_of(arg, crs)) {
                return box;
            }
        }
    }
    if (!expression.op.starts_with("s_")) {
        return std::nullopt;
    }
    const auto* const a = std::get_if<Cql2Geometry>(&expression.args.at(0).literal);
    const auto* const b = std::get_if<Cql2Geometry>(&expression.args.at(1).literal);
    return GeometryRelation{expression.op, a, b, crs}.box();
}

} // namespace

bool is_queryable(const FeatureColumn& column) {
    return column.type.kind != ColumnType::Kind::raw;
}

FeatureFilter feature_filter(const Cql2Expression& expression,
                             std::span<const FeatureColumn> columns,
                             CoordinateReference crs) {
    return {.test = [condition = Compiler{columns, crs}.truth(expression)](
                        const Feature& feature) { return condition(feature).value_or(false); },
            .box = box_of(expression, crs)};
}

} // namespace macadam
