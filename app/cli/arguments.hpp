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

/// Option in a command's table, with all that the parser and the help need.
struct Option {
    std::string_view name;       ///< "--length", or "-o,--output"
    std::string_view value;      ///< "METRES", "[METRES]" if it may be left out, "" for a flag
    std::string_view help;       ///< one sentence
    std::string_view fallback{}; ///< value without the option, as help shows it; "" = none
    bool many = false;           ///< takes all words up to the next option
};

/// Positional argument.
struct Operand {
    std::string_view name; ///< "STORE"
    std::string_view help;
    bool many = false;           ///< one or more; only the last operand may be
    std::string_view fallback{}; ///< value if omitted; last operand only
    bool optional = false;       ///< may be omitted; there is no value then
};

/// Words after the command's name, parsed by the command's tables. Values stay text until the
/// command asks for a type; a word that does not fit causes a UsageError that quotes it.
class Arguments {
public:
    /// \throws UsageError  for an unknown option, a missing value or operand, or a surplus word.
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

    /// Parses a value from a list of words; the first is the default.
    std::string choice(std::string_view name, std::span<const std::string_view> words) const;

    const std::string& operand(std::string_view name) const;
    const std::vector<std::string>& operands(std::string_view name) const;

private:
    std::map<std::string, std::vector<std::string>, std::less<>> words_;
};

} // namespace macadam
