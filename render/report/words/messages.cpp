#include "render/report/words/messages.hpp"

#include "render/report/words/catalogues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <stdexcept>
#include <unordered_map>

namespace macadam {
namespace {

/// Plural rule of English and German (CLDR: 1 is one, all else is other).
std::string_view one_or_other(std::size_t count) {
    return count == 1 ? "one" : "other";
}

std::vector<Message> joined(std::initializer_list<std::span<const Message>> catalogues) {
    std::vector<Message> all;
    for (const auto& each : catalogues) {
        all.insert(all.end(), each.begin(), each.end());
    }
    return all;
}

using Catalogue = std::unordered_map<std::string_view, const Message*>;

Catalogue catalogue_of(const Language& language) {
    Catalogue catalogue;
    for (const auto& message : language.messages) {
        catalogue.emplace(message.key, &message);
    }
    return catalogue;
}

const Catalogue& kept_catalogue(const Language& language) {
    static const auto all = [] {
        std::unordered_map<std::string_view, Catalogue> catalogues;
        for (const auto& each : languages()) {
            catalogues.emplace(each.code, catalogue_of(each));
        }
        return catalogues;
    }();
    return all.at(language.code);
}

} // namespace

std::span<const Language> languages() {
    static const auto english =
        joined({english_messages(), english_reference_messages(), english_site_messages()});
    static const auto german =
        joined({german_messages(), german_reference_messages(), german_site_messages()});
    static const std::array all{Language{"en", ".", "{year}-{month}-{day}", one_or_other, english},
                                Language{"de", ",", "{day}.{month}.{year}", one_or_other, german}};
    return all;
}

const Language* language(std::string_view code) {
    const auto found = std::ranges::find(languages(), code, &Language::code);
    return found == languages().end() ? nullptr : &*found;
}

const Message* find_message(const Language& language, std::string_view key) {
    const auto& catalogue = kept_catalogue(language);
    const auto found = catalogue.find(key);
    return found == catalogue.end() ? nullptr : found->second;
}

std::string say(const Language& language, std::string_view key, const Values& values) {
    const auto* const message = find_message(language, key);
    if (message == nullptr) {
        throw std::logic_error{fmt::format("no message '{}' in '{}'", key, language.code)};
    }
    std::string said;
    for (auto rest = message->text; !rest.empty();) {
        const auto open = std::min(rest.find('{'), rest.size());
        said += rest.substr(0, open);
        rest.remove_prefix(open);
        if (rest.empty()) {
            break;
        }
        const auto close = rest.find('}');
        const auto name = rest.substr(1, close - 1);
        const auto value = std::ranges::find(values, name, [](const auto& v) { return v.first; });
        if (value == values.end()) {
            throw std::logic_error{fmt::format("no value for '{}' in '{}'", name, key)};
        }
        said += value->second;
        rest.remove_prefix(close + 1);
    }
    return said;
}

std::vector<std::string> places_in(std::string_view text) {
    std::vector<std::string> names;
    for (auto at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1)) {
        names.emplace_back(text.substr(at + 1, text.find('}', at) - at - 1));
    }
    return names;
}

} // namespace macadam
