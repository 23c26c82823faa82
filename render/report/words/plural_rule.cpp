#include "render/report/words/plural_rule.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace macadam {

/// Node of the expression: a number, n, or an operator with its operands.
struct PluralRule::Node {
    std::string_view sign; ///< "?", "||", ...; "n"; "" = the number
    std::uint64_t number = 0;
    std::array<std::shared_ptr<const Node>, 3> of{};
};

namespace {

using Node = PluralRule::Node;
using NodePtr = std::shared_ptr<const Node>;

constexpr std::size_t max_forms = 6;        // of Arabic, the most that any language has
constexpr std::size_t max_letters = 1000;   // of the expression
constexpr int max_depth = 64;               // of brackets
constexpr std::size_t counts_tested = 1000; // rules depend on n modulo 10, 100 or 1000

/// Binary operators, those that bind least first; of a row, longer signs come first.
constexpr std::array<std::array<std::string_view, 4>, 6> levels{
    {{"||"}, {"&&"}, {"==", "!="}, {"<=", ">=", "<", ">"}, {"+", "-"}, {"*", "/", "%"}}};

class Parser {
public:
    explicit Parser(std::string_view text) : rest_{text} {}

    NodePtr whole() {
        auto node = choice(0);
        skip_blanks();
        if (!rest_.empty()) {
            refuse();
        }
        return node;
    }

private:
    [[noreturn]] void refuse() const {
        throw InputError{fmt::format("plural= has '{}', expected a C expression over n", rest_)};
    }

    void skip_blanks() {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) {
            rest_.remove_prefix(1);
        }
    }

    bool take(std::string_view sign) {
        skip_blanks();
        const bool found = !sign.empty() && rest_.starts_with(sign);
        rest_.remove_prefix(found ? sign.size() : 0);
        return found;
    }

    void expect(std::string_view sign) {
        if (!take(sign)) {
            refuse();
        }
    }

    NodePtr choice(int depth) {
        if (depth > max_depth) {
            throw InputError{fmt::format("plural= is nested more than {} deep", max_depth)};
        }
        auto condition = binary(0, depth);
        if (!take("?")) {
            return condition;
        }
        auto yes = choice(depth + 1);
        expect(":");
        auto no = choice(depth + 1);
        return make("?", std::move(condition), std::move(yes), std::move(no));
    }

    NodePtr binary(std::size_t level, int depth) {
        if (level == levels.size()) {
            return unary(depth);
        }
        auto left = binary(level + 1, depth);
        for (;;) {
            const auto& signs = levels.at(level);
            const auto* const sign =
                std::ranges::find_if(signs, [&](auto each) { return take(each); });
            if (sign == signs.end()) {
                return left;
            }
            auto right = binary(level + 1, depth);
            left = make(*sign, std::move(left), std::move(right));
        }
    }

    NodePtr unary(int depth) {
        if (depth > max_depth) {
            throw InputError{fmt::format("plural= is nested more than {} deep", max_depth)};
        }
        if (take("!")) {
            return make("!", unary(depth + 1));
        }
        if (take("(")) {
            auto inner = choice(depth + 1);
            expect(")");
            return inner;
        }
        if (take("n")) {
            return make("n");
        }
        return number();
    }

    NodePtr number() {
        constexpr std::size_t max_digits = 9;
        skip_blanks();
        Node node{};
        std::size_t digits = 0;
        while (digits < max_digits && !rest_.empty() && '0' <= rest_.front() &&
               rest_.front() <= '9') {
            node.number = 10 * node.number + static_cast<std::uint64_t>(rest_.front() - '0');
            rest_.remove_prefix(1);
            ++digits;
        }
        if (digits == 0) {
            refuse();
        }
        return std::make_shared<const Node>(std::move(node));
    }

    static NodePtr make(std::string_view sign, NodePtr a = {}, NodePtr b = {}, NodePtr c = {}) {
        Node node{};
        node.sign = sign;
        node.of = {std::move(a), std::move(b), std::move(c)};
        return std::make_shared<const Node>(std::move(node));
    }

    std::string_view rest_;
};

/// Computes the expression; a division by zero gives a value that is no form.
std::uint64_t value_of(const Node& node, std::uint64_t n) {
    const auto at = [&](std::size_t i) { return value_of(*node.of.at(i), n); };
    const auto sign = node.sign;
    if (sign.empty()) {
        return node.number;
    }
    if (sign == "n") {
        return n;
    }
    if (sign == "?") {
        return at(0) != 0 ? at(1) : at(2);
    }
    if (sign == "!") {
        return at(0) == 0 ? 1 : 0;
    }
    const auto a = at(0);
    const auto b = at(1);
    if (sign == "/" || sign == "%") {
        return b == 0 ? max_forms : sign == "/" ? a / b : a % b;
    }
    return sign == "||"   ? static_cast<std::uint64_t>(a != 0 || b != 0)
           : sign == "&&" ? static_cast<std::uint64_t>(a != 0 && b != 0)
           : sign == "==" ? static_cast<std::uint64_t>(a == b)
           : sign == "!=" ? static_cast<std::uint64_t>(a != b)
           : sign == "<=" ? static_cast<std::uint64_t>(a <= b)
           : sign == ">=" ? static_cast<std::uint64_t>(a >= b)
           : sign == "<"  ? static_cast<std::uint64_t>(a < b)
           : sign == ">"  ? static_cast<std::uint64_t>(a > b)
           : sign == "+"  ? a + b
           : sign == "-"  ? a - b
                          : a * b;
}

/// Returns what follows "name=" up to the next semicolon.
std::string_view part_of(std::string_view text, std::string_view name) {
    const auto at = text.find(name);
    if (at == std::string_view::npos) {
        throw InputError{fmt::format("Plural-Forms is '{}', expected "
                                     "'nplurals=NUMBER; plural=EXPRESSION;'",
                                     text)};
    }
    const auto part = text.substr(at + name.size());
    return part.substr(0, part.find(';'));
}

} // namespace

PluralRule::PluralRule() : PluralRule{"nplurals=2; plural=(n != 1);"} {}

PluralRule::PluralRule(std::string_view text) {
    const auto expression = part_of(text, " plural=");
    if (expression.size() > max_letters) {
        throw InputError{fmt::format(
            "plural= has {} characters, expected at most {}", expression.size(), max_letters)};
    }
    const auto count = part_of(text, "nplurals=");
    forms_ = count.size() == 1 && '1' <= count[0] && count[0] <= '9'
                 ? static_cast<std::size_t>(count[0] - '0')
                 : 0;
    if (forms_ < 1 || forms_ > max_forms) {
        throw InputError{fmt::format("nplurals is '{}', expected 1 to {}", count, max_forms)};
    }
    root_ = Parser{expression}.whole();
    for (std::size_t n = 0; n <= counts_tested; ++n) {
        if (const auto value = value_of(*root_, n); value >= forms_) {
            throw InputError{
                fmt::format("plural= gives no form below nplurals={} for n = {}", forms_, n)};
        }
    }
}

std::size_t PluralRule::form(std::size_t count) const {
    return std::min<std::size_t>(value_of(*root_, count), forms_ - 1);
}

} // namespace macadam
