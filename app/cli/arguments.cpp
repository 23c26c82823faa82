#include "app/cli/arguments.hpp"

#include "storage/text/spelling.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/exact_number.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

double number_in(std::string_view name, std::string_view word) {
    const auto number = exact_number<double>(word.starts_with('+') ? word.substr(1) : word);
    if (!number) {
        throw UsageError{fmt::format("{} is '{}', expected a number", name, word)};
    }
    return *number;
}

void add_options(CLI::App& parser,
                 std::span<const Option> options,
                 std::map<std::string, std::vector<std::string>, std::less<>>& words) {
    for (const auto& option : options) {
        auto& values = words[long_name(option)];
        if (option.value.empty()) {
            parser
                .add_flag_function(std::string{option.name},
                                   [&values](std::int64_t) { values = {"yes"}; })
                ->disable_flag_override();
        } else if (option.many) {
            parser.add_option(std::string{option.name}, values)->expected(1, -1);
        } else if (option.value.starts_with('[')) {
            parser.add_option(std::string{option.name}, values)
                ->expected(0, 1)
                ->allow_extra_args(false)
                ->take_last();
        } else {
            auto* const added = parser.add_option(std::string{option.name}, values)
                                    ->expected(1)
                                    ->allow_extra_args(false);
            if (option.is_repeatable) {
                added->take_all();
            } else {
                added->take_last();
            }
        }
    }
}

std::vector<std::string> names_of(std::span<const Option> options) {
    std::vector<std::string> names;
    std::ranges::transform(options, std::back_inserter(names), long_name);
    return names;
}

/// Returns the option with one value whose value directly precedes a word; nullptr if there is
/// none.
const Option* option_before(std::span<const Option> options,
                            std::span<const std::string> words,
                            std::size_t word) {
    if (word < 2) {
        return nullptr;
    }
    const auto found = std::ranges::find_if(options, [&](const Option& option) {
        const auto end = option.name.find(',');
        return !option.value.empty() && !option.value.starts_with('[') && !option.many &&
               (words[word - 2] == long_name(option) ||
                words[word - 2] == option.name.substr(0, end));
    });
    return found == options.end() ? nullptr : &*found;
}

/// Rejects a command line with surplus words. Spaces within a list of numbers are likelier than a
/// surplus operand.
[[noreturn]] void refuse_surplus(std::span<const Option> options,
                                 std::span<const std::string> words,
                                 const std::string& surplus) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto* const option = option_before(options, words, i);
        const bool splits_list = option != nullptr &&
                                 option->value.find(',') != std::string_view::npos &&
                                 words[i].find_first_not_of("+-.,0123456789") == std::string::npos;
        if (splits_list || (option != nullptr && words[i] == surplus)) {
            throw UsageError{fmt::format("unexpected '{}'; {} takes one value, {}",
                                         words[i],
                                         long_name(*option),
                                         option->value)};
        }
    }
    throw UsageError{fmt::format("unexpected '{}'", surplus)};
}

/// Rejects the words that CLI11 did not use.
[[noreturn]] void refuse_extras(std::span<const Option> options,
                                std::span<const std::string> words,
                                const std::vector<std::string>& extras) {
    for (const auto& extra : extras) {
        if (extra.size() > 1 && extra.front() == '-') {
            const auto name = std::string_view{extra}.substr(0, extra.find('='));
            throw UsageError{
                fmt::format("unknown option {}{}", name, suggestion(name, names_of(options)))};
        }
    }
    refuse_surplus(options, words, extras.empty() ? "" : extras.front());
}

/// Assigns each operand its word, and the last one all remaining words if it takes many.
void distribute(std::span<const Option> options,
                std::span<const Operand> operands,
                std::span<const std::string> all,
                const std::vector<std::string>& given,
                std::map<std::string, std::vector<std::string>, std::less<>>& words) {
    for (std::size_t i = 0; i < operands.size(); ++i) {
        if (i >= given.size() && !operands[i].fallback.empty()) {
            words[std::string{operands[i].name}] = {std::string{operands[i].fallback}};
            continue;
        }
        if (i >= given.size() && operands[i].optional) {
            words[std::string{operands[i].name}] = {};
            continue;
        }
        if (i >= given.size()) {
            throw UsageError{fmt::format("{} is missing", operands[i].name)};
        }
        words[std::string{operands[i].name}] = {given[i]};
    }
    if (given.size() > operands.size()) {
        if (!operands.back().many) {
            refuse_surplus(options, all, given[operands.size()]);
        }
        words[std::string{operands.back().name}].assign(
            given.begin() + static_cast<std::ptrdiff_t>(operands.size()) - 1, given.end());
    }
}

/// Rejects flags with a value; CLI11 would name the flag without its dashes.
void expect_flags_alone(std::span<const Option> options, const std::vector<std::string>& words) {
    for (const auto& word : words) {
        const auto name = word.substr(0, word.find('='));
        const bool is_flag = std::ranges::any_of(options, [&](const Option& option) {
            return option.value.empty() && long_name(option) == name;
        });
        if (is_flag && name.size() < word.size()) {
            throw UsageError{fmt::format("{} takes no value, but '{}' is given", name, word)};
        }
    }
}

/// Replaces earlier spellings of options by the present ones, with a note for each.
/// \throws UsageError  for an earlier spelling whose meaning has changed.
std::vector<std::string> in_present_spelling(std::span<const Option> options,
                                             std::vector<std::string> words,
                                             std::vector<std::string>& notes) {
    for (auto& word : words) {
        const auto given = word.substr(0, word.find('='));
        const auto found = std::ranges::find_if(options, [&](const Option& option) {
            return !option.former.empty() && option.former == given;
        });
        if (found == options.end()) {
            continue;
        }
        if (found->former_is_refused) {
            throw UsageError{fmt::format("{} is called {} here now", given, long_name(*found))};
        }
        notes.push_back(fmt::format("{} is called {} now", given, long_name(*found)));
        word.replace(0, given.size(), long_name(*found));
    }
    return words;
}

/// Parses the values of options into `values`. \returns the operands.
std::vector<std::string>
parsed(std::span<const Option> options,
       std::span<const Operand> operands,
       const std::vector<std::string>& words,
       std::map<std::string, std::vector<std::string>, std::less<>>& values) {
    CLI::App parser;
    parser.set_help_flag();
    add_options(parser, options, values);
    // A single list holds all operands: CLI11 would let the first of several take every word.
    std::vector<std::string> given;
    if (!operands.empty()) {
        const bool is_required = !std::ranges::all_of(operands, &Operand::optional);
        parser.add_option("operands", given)->required(is_required)->expected(1, -1);
    }
    try {
        parser.parse(std::vector<std::string>{words.rbegin(),
                                              words.rend()}); // CLI11 takes words from the back
    } catch (const CLI::RequiredError&) {
        given.clear(); // distribute() reports the missing operand
    } catch (const CLI::ExtrasError&) {
        refuse_extras(options, words, parser.remaining());
    } catch (const CLI::ParseError& error) {
        throw UsageError{error.what()};
    }
    return given;
}

bool is_short_of(std::span<const Operand> operands, const std::vector<std::string>& given) {
    const auto required = std::ranges::count_if(operands, [](const Operand& operand) {
        return !operand.optional && operand.fallback.empty();
    });
    return std::ssize(given) < required;
}

/// Takes a word from an option whose value may be left out, and puts it before the option, as an
/// operand: `query --excel roads.gpkg`. \returns whether there is such a word.
bool give_back_word(std::span<const Option> options, std::vector<std::string>& words) {
    const auto takes_word = [&](const std::string& word, const std::string& next) {
        return !next.starts_with('-') && std::ranges::any_of(options, [&](const Option& option) {
            return option.value.starts_with('[') && long_name(option) == word;
        });
    };
    const auto found = std::ranges::adjacent_find(words, takes_word);
    if (found == words.end()) {
        return false;
    }
    std::iter_swap(found, std::next(found));
    return true;
}

/// Replaces the values of options with choices by the choices themselves, whatever their case.
void adopt_choices(std::span<const Option> options,
                   std::map<std::string, std::vector<std::string>, std::less<>>& words) {
    for (const auto& option : options) {
        if (option.choices.empty()) {
            continue;
        }
        const auto choices = choices_in(option.choices);
        for (auto& word : words.at(long_name(option))) {
            const auto choice = choice_among(choices, word);
            if (!choice) {
                throw UsageError{fmt::format("{} is '{}', expected {}",
                                             long_name(option),
                                             word,
                                             fmt::join(choices, " or "))};
            }
            word = *choice;
        }
    }
}

} // namespace

std::string long_name(const Option& option) {
    return std::string{option.name.substr(option.name.rfind(',') + 1)};
}

std::optional<std::string> choice_among(std::span<const std::string_view> choices,
                                        std::string_view word) {
    const auto found = std::ranges::find_if(
        choices, [&](auto choice) { return in_lower_case(choice) == in_lower_case(word); });
    return found == choices.end() ? std::nullopt : std::optional{std::string{*found}};
}

std::vector<std::string_view> choices_in(std::string_view choices) {
    std::vector<std::string_view> words;
    for (auto rest = choices; !rest.empty();) {
        const auto end = std::min(rest.find('|'), rest.size());
        words.push_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return words;
}

Arguments::Arguments(std::span<const Option> options,
                     std::span<const Operand> operands,
                     std::vector<std::string> words) {
    words = in_present_spelling(options, std::move(words), notes_);
    expect_flags_alone(options, words);
    auto given = parsed(options, operands, words, words_);
    while (is_short_of(operands, given) && give_back_word(options, words)) {
        words_.clear();
        given = parsed(options, operands, words, words_);
    }
    distribute(options, operands, words, given, words_);
    adopt_choices(options, words_);
    for (const auto& option : options) {
        if (const auto choices = choices_in(option.choices); !choices.empty()) {
            choices_.emplace(long_name(option), choices);
        }
    }
}

void Arguments::adopt(std::span<const Default> defaults) {
    for (const auto& [option, value, source] : defaults) {
        const auto found = words_.find(option);
        if (found == words_.end() || !found->second.empty()) {
            continue;
        }
        const auto choices = choices_.find(option);
        const auto word =
            choices == choices_.end() ? std::optional{value} : choice_among(choices->second, value);
        if (word) {
            found->second = {*word};
            defaults_.push_back({option, *word, source});
        }
    }
}

bool Arguments::is_given(std::string_view name) const {
    return !values(name).empty() && std::ranges::count(defaults_, name, &Default::option) == 0;
}

bool Arguments::flag(std::string_view name) const {
    return !values(name).empty();
}

std::vector<std::string> Arguments::values(std::string_view name) const {
    return operands(name);
}

std::optional<std::string> Arguments::value(std::string_view name) const {
    const auto found = values(name);
    return found.empty() ? std::nullopt : std::optional{found.back()};
}

std::optional<double> Arguments::number(std::string_view name) const {
    const auto word = value(name);
    return word ? std::optional{number_in(name, *word)} : std::nullopt;
}

double Arguments::number(std::string_view name, double fallback) const {
    return number(name).value_or(fallback);
}

std::optional<std::int64_t> Arguments::integer(std::string_view name) const {
    const auto word = value(name);
    if (!word) {
        return std::nullopt;
    }
    const auto number = exact_number<std::int64_t>(*word);
    if (!number) {
        throw UsageError{fmt::format("{} is '{}', expected a whole number", name, *word)};
    }
    return number;
}

std::optional<std::vector<double>> Arguments::numbers(std::string_view name,
                                                      std::size_t count) const {
    const auto word = value(name);
    if (!word) {
        return std::nullopt;
    }
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= word->size();) {
        const auto end = std::min(word->find(',', begin), word->size());
        numbers.push_back(number_in(name, std::string_view{*word}.substr(begin, end - begin)));
        begin = end + 1;
    }
    if (numbers.size() != count) {
        throw UsageError{
            fmt::format("{} is '{}', expected {} numbers separated by commas", name, *word, count)};
    }
    return numbers;
}

std::string Arguments::choice(std::string_view name) const {
    return value(name).value_or(std::string{choices(name).front()});
}

const std::vector<std::string_view>& Arguments::choices(std::string_view name) const {
    const auto found = choices_.find(name);
    if (found == choices_.end()) {
        throw std::logic_error{fmt::format("the command's table has no choices for {}", name)};
    }
    return found->second;
}

const std::string& Arguments::operand(std::string_view name) const {
    return operands(name).front();
}

const std::vector<std::string>& Arguments::operands(std::string_view name) const {
    const auto found = words_.find(name);
    if (found == words_.end()) {
        throw std::logic_error{fmt::format("the command's table has no {}", name)};
    }
    return found->second;
}

} // namespace macadam
