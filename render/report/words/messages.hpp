#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// A sentence or word of a report in one language. `{name}` is a place for a value. Where a number
/// decides the form the key ends in a plural category: "trips.one", "trips.other".
struct Message {
    std::string_view key;
    std::string_view text;
};

/// All that differs from one language to another. Another language is two more files of
/// messages (words_en.cpp and words_reference_en.cpp have them all) and a row in languages().
struct Language {
    std::string_view code; ///< BCP 47: "en"
    std::string_view decimal_mark;
    std::string_view day; ///< how a day is written, of {year} {month} {day}
    std::string_view (*plural)(std::size_t count); ///< CLDR category: "one", "other", ...
    std::span<const Message> messages;
};

/// English first, which is the default.
std::span<const Language> languages();

/// Null if there is none of that code.
const Language* language(std::string_view code);

/// Values for the places of a message, by name.
using Values = std::vector<std::pair<std::string_view, std::string>>;

/// Null if the language has no such message.
const Message* find_message(const Language& language, std::string_view key);

/// The message with its values. A key that the language lacks, or a place without a value, is our
/// own mistake. \throws std::logic_error
std::string say(const Language& language, std::string_view key, const Values& values = {});

/// Names of a text's places, in their order.
std::vector<std::string> places_in(std::string_view text);

} // namespace macadam
