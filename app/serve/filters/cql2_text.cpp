#include "app/serve/filters/cql2_text.hpp"

#include "app/serve/filters/cql2_literals.hpp"
#include "app/serve/filters/cql2_wkt.hpp"
#include "app/serve/filters/cql2_words.hpp"
#include "estimator/common/ascii.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace macadam {
namespace {

Cql2Expression call_of(std::string_view op, std::vector<Cql2Expression> args) {
    return {.op = std::string{op}, .args = std::move(args), .literal = {}};
}

template <typename... Operands>
Cql2Expression call(std::string_view op, Operands... operands) {
    std::vector<Cql2Expression> args;
    (args.push_back(std::move(operands)), ...);
    return call_of(op, std::move(args));
}

Cql2Expression literal(Cql2Expression::Literal value) {
    return {.op = {}, .args = {}, .literal = std::move(value)};
}

bool is_reserved(std::string_view word) {
    constexpr std::array<std::string_view, 9> reserved{
        "and", "or", "not", "like", "between", "in", "is", "null", "div"};
    return std::ranges::find(reserved, in_lower_case(word)) != reserved.end();
}

class TextParser {
public:
    explicit TextParser(std::string_view text) : words_{text} {}

    Cql2Expression whole() {
        auto expression = either();
        words_.expect_end();
        return expression;
    }

private:
    /// Level of brackets, functions and operators within one another.
    class Level {
    public:
        explicit Level(int& depth) : depth_{depth} {
            if (++depth_ > max_cql2_depth) {
                --depth_; // there is no destructor after an exception
                throw Cql2Error{
                    fmt::format("the filter is nested more than {} deep", max_cql2_depth)};
            }
        }
        Level(const Level&) = delete;
        Level& operator=(const Level&) = delete;
        ~Level() { --depth_; }

    private:
        int& depth_;
    };

    /// Expressions joined by a word, as one call with all of them.
    template <typename Operand>
    Cql2Expression joined(std::string_view word, const Operand& operand) {
        auto first = operand();
        if (!words_.take_word(word)) {
            return first;
        }
        std::vector<Cql2Expression> args{std::move(first)};
        do {
            args.push_back(operand());
        } while (words_.take_word(word));
        return call_of(word, std::move(args));
    }

    Cql2Expression either() {
        return joined("or", [this] { return joined("and", [this] { return negation(); }); });
    }

    Cql2Expression negation() {
        const Level level{depth_};
        if (words_.take_word("not")) {
            return call("not", negation());
        }
        return comparison();
    }

    Cql2Expression comparison() {
        auto left = sum();
        for (const std::string_view op : {"=", "<>", "<=", ">=", "<", ">"}) { // longer ones first
            if (words_.take(op)) {
                return call(op, std::move(left), sum());
            }
        }
        if (words_.take_word("is")) {
            const bool is_negated = words_.take_word("not");
            words_.expect_word("null");
            return negated_if(is_negated, call("isNull", std::move(left)));
        }
        const bool is_negated = words_.take_word("not");
        if (words_.take_word("like")) {
            return negated_if(is_negated, call("like", std::move(left), primary()));
        }
        if (words_.take_word("between")) {
            auto low = sum();
            words_.expect_word("and");
            return negated_if(is_negated, call("between", std::move(left), std::move(low), sum()));
        }
        if (words_.take_word("in")) {
            auto list = call_of("list", arguments());
            return negated_if(is_negated, call("in", std::move(left), std::move(list)));
        }
        if (is_negated) {
            words_.refuse("LIKE, BETWEEN or IN");
        }
        return left;
    }

    static Cql2Expression negated_if(bool is_negated, Cql2Expression expression) {
        return is_negated ? call("not", std::move(expression)) : std::move(expression);
    }

    /// Operands joined by operators of one rank, from left to right.
    template <typename Operand>
    Cql2Expression chain(std::initializer_list<std::string_view> operators,
                         const Operand& operand) {
        auto left = operand();
        for (int length = 0;; ++length) {
            const auto* const op = std::ranges::find_if(operators, [this](std::string_view word) {
                return word == "div" ? words_.take_word(word) : words_.take(word);
            });
            if (op == operators.end()) {
                return left;
            }
            if (length == max_cql2_depth) {
                throw Cql2Error{
                    fmt::format("more than {} operators follow one another", max_cql2_depth)};
            }
            left = call(*op, std::move(left), operand());
        }
    }

    Cql2Expression sum() {
        return chain({"+", "-"}, [this] {
            return chain({"*", "/", "%", "div"}, [this] { return power(); });
        });
    }

    Cql2Expression power() {
        const Level level{depth_};
        auto base = primary();
        if (words_.take("^")) {
            return call("^", std::move(base), power());
        }
        return base;
    }

    std::vector<Cql2Expression> arguments() {
        const Level level{depth_};
        words_.expect("(");
        std::vector<Cql2Expression> args;
        do {
            args.push_back(either());
        } while (words_.take(","));
        words_.expect(")");
        return args;
    }

    Cql2Expression primary() {
        if (words_.is_at('(')) {
            auto within = arguments();
            if (within.size() != 1) {
                words_.refuse("one expression in brackets");
            }
            return std::move(within.front());
        }
        if (words_.is_at('\'')) {
            return literal(words_.quoted());
        }
        if (const auto number = words_.number()) {
            return literal(*number);
        }
        if (words_.is_at('"')) {
            return literal(Cql2Property{words_.quoted_name()});
        }
        const auto word = words_.name();
        if (word.empty() || is_reserved(word)) {
            words_.refuse("a property, a value or a function", word);
        }
        return words_.is_at('(') || is_cql2_geometry(word) ? function(word) : named(word);
    }

    static Cql2Expression named(const std::string& word) {
        const auto lower = in_lower_case(word);
        return lower == "true"    ? literal(true)
               : lower == "false" ? literal(false)
                                  : literal(Cql2Property{word});
    }

    Cql2Expression function(const std::string& word) {
        const auto lower = in_lower_case(word);
        if (is_cql2_geometry(word)) {
            return literal(parse_cql2_wkt(word, words_));
        }
        if (lower == "date" || lower == "timestamp") {
            words_.expect("(");
            const auto instant = parse_cql2_instant(words_.quoted());
            words_.expect(")");
            if (instant.is_day != (lower == "date")) {
                words_.refuse(lower == "date" ? "DATE('2026-05-01')"
                                              : "TIMESTAMP('2026-05-01T06:00:00Z')");
            }
            return literal(instant);
        }
        if (lower == "interval") {
            words_.expect("(");
            auto begin = border();
            words_.expect(",");
            Cql2Interval interval{std::move(begin), border()};
            words_.expect(")");
            return literal(std::move(interval));
        }
        const auto name = cql2_function(word);
        if (!name) {
            throw Cql2Error{fmt::format("there is no function {}", in_quotes(word))};
        }
        return call_of(*name, arguments());
    }

    Cql2Border border() {
        if (words_.is_at('\'')) {
            return parse_cql2_border(words_.quoted());
        }
        auto name = words_.is_at('"') ? words_.quoted_name() : words_.name();
        if (name.empty()) {
            words_.refuse("a time in quotes, '..' or a property");
        }
        return Cql2Property{std::move(name)};
    }

    Cql2Words words_;
    int depth_ = 0;
};

} // namespace

Cql2Expression parse_cql2_text(std::string_view text) {
    if (text.size() > max_cql2_bytes) {
        throw Cql2Error{fmt::format(
            "the filter has {} bytes, expected at most {}", text.size(), max_cql2_bytes)};
    }
    return TextParser{text}.whole();
}

} // namespace macadam
