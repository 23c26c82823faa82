#include "app/manual/value_hint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace macadam {
namespace {

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

bool names_files(std::string_view value) {
    constexpr std::array<std::string_view, 6> names{
        "FILE", "STORE", "SURVEY", "TRIP", "PATH", "PROFILE"};
    return std::ranges::any_of(names, [&](auto name) { return contains(value, name); }) ||
           value == "A" || value == "B"; // the two sources of 'compare'
}

bool is_in_suffix(char c) {
    return c == '.' || std::islower(static_cast<unsigned char>(c)) != 0 ||
           std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Returns the suffixes in a text: {".csv", ".trip.csv.gz"} for "FILE.csv or a .trip.csv.gz file".
std::vector<std::string> suffixes_in(std::string_view text) {
    std::vector<std::string> suffixes;
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
        if (text[i] != '.' || std::islower(static_cast<unsigned char>(text[i + 1])) == 0) {
            continue;
        }
        const auto* const end = std::find_if_not(text.begin() + i, text.end(), is_in_suffix);
        std::string suffix{text.begin() + i, end};
        suffix.erase(suffix.find_last_not_of('.') + 1); // the end of a sentence
        i += suffix.size() - 1;
        const bool is_page = suffix == ".md"; // a page of the documentation
        if (!is_page && std::ranges::find(suffixes, suffix) == suffixes.end()) {
            suffixes.push_back(std::move(suffix));
        }
    }
    return suffixes;
}

/// Tests whether a help ends a list of suffixes with "...", other than in "postgresql://...".
bool leaves_suffixes_out(std::string_view help) {
    const auto dots = help.find("...");
    return dots != help.npos && !help.substr(0, dots).ends_with("://");
}

ValueHint hint_of_words(std::string_view choices) {
    return {ValueHint::Kind::words, choices_in(choices), {}};
}

ValueHint hint_of_files(std::string_view value, std::string_view help, bool many) {
    if (!names_files(value)) {
        const bool is_folder = contains(value, "DIR");
        return {is_folder ? ValueHint::Kind::folders : ValueHint::Kind::none, {}, {}};
    }
    const bool has_others = many || leaves_suffixes_out(help) || contains(help, " any ");
    return {ValueHint::Kind::files,
            {},
            has_others ? std::vector<std::string>{}
                       : suffixes_in(fmt::format("{} {}", value, help))};
}

} // namespace

ValueHint value_hint_of(const Option& option) {
    return option.choices.empty() ? hint_of_files(option.value, option.help, option.many)
                                  : hint_of_words(option.choices);
}

ValueHint value_hint_of(const Operand& operand) {
    return operand.choices.empty() ? hint_of_files(operand.name, operand.help, operand.many)
                                   : hint_of_words(operand.choices);
}

} // namespace macadam
