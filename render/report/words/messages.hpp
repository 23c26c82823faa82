#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Sentence or word of a report in one language. `{name}` is a placeholder. If a number determines
/// the form, the key ends in a plural category: "trips.one", "trips.other".
struct Message {
    std::string_view key;
    std::string_view text;
};

/// Properties of a language. A new language requires three files of messages (messages_en.cpp,
/// messages_reference_en.cpp and messages_site_en.cpp have them all) and a row in languages().
struct Language {
    std::string_view code; ///< BCP 47: "en"
    std::string_view decimal_mark;
    std::string_view day;                          ///< date format with {year} {month} {day}
    std::string_view (*plural)(std::size_t count); ///< CLDR category: "one", "other", ...
    std::span<const Message> messages;
};

/// Returns all languages; English, the default, is first.
std::span<const Language> languages();

/// Returns a null pointer if the code is unknown.
const Language* language(std::string_view code);

/// Values for the placeholders of a message, by name.
using Values = std::vector<std::pair<std::string_view, std::string>>;

/// Returns a null pointer if the language has no such message.
const Message* find_message(const Language& language, std::string_view key);

/// Returns the message with its values. A key missing from the language, or a placeholder without a
/// value, is a programming error. \throws std::logic_error
std::string say(const Language& language, std::string_view key, const Values& values = {});

/// Returns the names of a text's placeholders, in order.
std::vector<std::string> places_in(std::string_view text);

} // namespace macadam
