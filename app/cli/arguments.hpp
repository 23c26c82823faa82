#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Error in the command line; main() answers with the command's usage and exit status 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Option in a command's table, with all that the parser, the help, the manual pages and the
/// completion of shells need.
struct Option {
    std::string_view name;          ///< "--length", or "-o,--output"
    std::string_view value;         ///< "METRES", "[METRES]" if it may be left out, "" for a flag
    std::string_view help;          ///< one sentence
    std::string_view fallback{};    ///< value without the option, as help shows it; "" = none
    bool many = false;              ///< takes all words up to the next option
    std::string_view choices{};     ///< "light|dark|print": the only values; "" = any
    std::string_view group{};       ///< heading in the help; "" = "options"
    bool rare = false;              ///< shown by --help-all and in the manual page only
    std::string_view former{};      ///< earlier spelling: an alias that is answered with a note
    bool former_is_refused = false; ///< the earlier spelling meant something else: a UsageError
    bool is_preference = false;     ///< users may set a default (app/config)
    bool is_repeatable = false;     ///< each occurrence adds its value; otherwise the last counts
};

/// \name Words of the tables: `rare(one_of("csv|json", {"--format", ...}))`
/// @{
constexpr Option one_of(std::string_view choices, Option option) {
    option.choices = choices;
    return option;
}
constexpr Option in_group(std::string_view group, Option option) {
    option.group = group;
    return option;
}
constexpr Option rare(Option option) {
    option.rare = true;
    return option;
}
constexpr Option formerly(std::string_view name, Option option) {
    option.former = name;
    return option;
}
constexpr Option instead_of(std::string_view refused, Option option) {
    option.former = refused;
    option.former_is_refused = true;
    return option;
}
constexpr Option repeatable(Option option) {
    option.is_repeatable = true;
    return option;
}
constexpr Option preference(Option option) {
    option.is_preference = true;
    return option;
}
/// @}

/// Default of an option that the user has set.
struct Default {
    std::string option; ///< "--unit"
    std::string value;  ///< as on the command line; "yes" for a flag
    std::string source; ///< "/home/ada/.config/macadam/config.toml:3", "MACADAM_UNIT"
};

/// Returns "--output" for "-o,--output".
std::string long_name(const Option& option);

/// Returns {"light", "dark", "print"} for "light|dark|print".
std::vector<std::string_view> choices_in(std::string_view choices);

/// Returns the choice that a word names, whatever its case; `std::nullopt` if it names none.
std::optional<std::string> choice_among(std::span<const std::string_view> choices,
                                        std::string_view word);

/// Positional argument.
struct Operand {
    std::string_view name; ///< "STORE"
    std::string_view help;
    bool many = false;           ///< one or more; only the last operand may be
    std::string_view fallback{}; ///< value if omitted; last operand only
    bool optional = false;       ///< may be omitted; there is no value then
    std::string_view choices{};  ///< "own|crowd": values that shells complete; "" = any
};

/// Words after the command's name, parsed by the command's tables. Values stay text until the
/// command asks for a type; a word that does not fit causes a UsageError that quotes it.
class Arguments {
public:
    /// \throws UsageError  for an unknown option, a missing value or operand, a value that is none
    ///                     of the option's choices, or a surplus word.
    Arguments(std::span<const Option> options,
              std::span<const Operand> operands,
              std::vector<std::string> words);

    bool flag(std::string_view name) const;
    std::optional<std::string> value(std::string_view name) const;
    std::vector<std::string> values(std::string_view name) const;
    std::optional<double> number(std::string_view name) const;
    double number(std::string_view name, double fallback) const;
    std::optional<std::int64_t> integer(std::string_view name) const;

    /// Parses comma-separated numbers: `--bbox W,S,E,N`.
    /// \throws UsageError  if there are not `count`.
    std::optional<std::vector<double>> numbers(std::string_view name, std::size_t count) const;

    /// Returns the value of an option with choices; the first choice is the default.
    std::string choice(std::string_view name) const;
    /// Returns the choices of an option that has some.
    const std::vector<std::string_view>& choices(std::string_view name) const;

    const std::string& operand(std::string_view name) const;
    const std::vector<std::string>& operands(std::string_view name) const;

    /// Gives options that are not on the command line the user's defaults. A default that is none
    /// of the choices of this command is left out: other commands offer it.
    void adopt(std::span<const Default> defaults);

    /// Tests whether the command has an option.
    bool has(std::string_view name) const { return words_.contains(name); }

    /// Tests whether an option is on the command line. Only then may it be refused for having no
    /// effect; a default never is.
    bool is_given(std::string_view name) const;

    /// Returns the defaults that apply.
    const std::vector<Default>& defaults() const { return defaults_; }

    /// Returns a sentence for each option that was given in an earlier spelling.
    const std::vector<std::string>& notes() const { return notes_; }

private:
    std::map<std::string, std::vector<std::string>, std::less<>> words_;
    std::map<std::string, std::vector<std::string_view>, std::less<>> choices_;
    std::vector<std::string> notes_;
    std::vector<Default> defaults_;
};

} // namespace macadam
