#pragma once

#include "render/report/words/plural_rule.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Words of a language, from a gettext catalogue. The context of an entry (msgctxt) is the key of
/// its message; `{name}` in the text is a placeholder. Where a translation is missing, the text is
/// English.
struct Language {
    std::string code; ///< BCP 47: "en"
    PluralRule plural;
    /// By key: one text, or one per plural form.
    std::map<std::string, std::vector<std::string>, std::less<>> messages;
};

/// Returns the language of the template macadam.pot: the default.
/// \throws InputError  as of languages().
const Language& english();

/// Returns all languages in share/macadam/languages, each a file CODE.po; English is first.
/// \throws InputError  if the folder is not there or one of its files is not a catalogue.
std::vector<const Language*> languages();

/// Returns a null pointer if the folder has no catalogue of that code.
const Language* language(std::string_view code);

/// Reads a catalogue from any place; it stays in memory.
/// \throws InputError  if it cannot be read, is no catalogue, or has a placeholder that the English
///                     text does not have.
const Language& language_from(const std::filesystem::path& file);

/// Values for the placeholders of a message, by name.
using Values = std::vector<std::pair<std::string_view, std::string>>;

/// Returns the text of a message, of which the form for a plural if it has several; null if there
/// is no such message.
const std::string* find_message(const Language& language, std::string_view key, std::size_t n = 0);

/// Returns the message with its values, in the plural form of n. A key missing from the language,
/// or a placeholder without a value, is a programming error. \throws std::logic_error
std::string
say(const Language& language, std::string_view key, const Values& values = {}, std::size_t n = 0);

/// Returns the names of a text's placeholders, in order.
/// \throws InputError  if a bracket is not closed.
std::vector<std::string> places_in(std::string_view text);

} // namespace macadam
