#include "render/report/words/messages.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "render/report/words/po_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace macadam {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view template_name = "macadam.pot";

std::vector<PoEntry> read_po(const fs::path& file) {
    constexpr std::size_t max_bytes = 4'000'001; // parse_po refuses one more than it takes
    std::ifstream stream;
    std::error_code error;
    if (fs::is_regular_file(file, error)) { // a pipe without a writer would keep open() waiting
        stream.open(file, std::ios::binary);
    }
    if (!stream.is_open()) {
        throw InputError{
            fmt::format("{}: cannot be read, expected a catalogue (.po)", file.string())};
    }
    std::string text(max_bytes, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return parse_po(text, file.string());
}

/// Returns a field of the header, "Plural-Forms"; "" if it is not there.
std::string header_field(const std::vector<PoEntry>& entries, std::string_view name) {
    if (entries.empty() || !entries.front().id.empty()) {
        return {};
    }
    const auto& header = entries.front().strings.front();
    const auto begin = fmt::format("{}: ", name);
    for (std::size_t at = 0; at < header.size();
         at = std::min(header.find('\n', at), header.size()) + 1) {
        if (header.compare(at, begin.size(), begin) == 0) {
            const auto from = at + begin.size();
            return header.substr(from, std::min(header.find('\n', from), header.size()) - from);
        }
    }
    return {};
}

Language english_of(const std::vector<PoEntry>& entries) {
    Language language;
    language.code = "en";
    for (const auto& entry : entries) {
        if (entry.context.empty()) {
            continue;
        }
        auto& forms = language.messages[entry.context];
        forms = {entry.id};
        if (!entry.plural_id.empty()) {
            forms.push_back(entry.plural_id);
        }
    }
    return language;
}

/// Checks the placeholders of a translation. \throws InputError
void check_places(const PoEntry& entry,
                  const std::vector<std::string>& english,
                  const fs::path& file) {
    const auto known = places_in(english.back());
    for (const auto& text : entry.strings) {
        try {
            for (const auto& place : places_in(text)) {
                if (std::ranges::find(known, place) == known.end()) {
                    throw InputError{fmt::format("{{{}}} is not in the English text, expected {}",
                                                 place,
                                                 fmt::join(known, ", "))};
                }
            }
        } catch (const InputError& error) {
            throw InputError{fmt::format("{}:{}: {}", file.string(), entry.line, error.what())};
        }
    }
}

/// Puts the translations of a catalogue over the English texts.
Language translated(const Language& english, const fs::path& file) {
    const auto entries = read_po(file);
    Language language = english;
    language.code = header_field(entries, "Language");
    std::ranges::replace(language.code, '_', '-');
    if (language.code.empty()) {
        language.code = file.stem().string();
    }
    try {
        language.plural = PluralRule{header_field(entries, "Plural-Forms")};
    } catch (const InputError& error) {
        throw InputError{fmt::format("{}: {}", file.string(), error.what())};
    }
    for (const auto& entry : entries) {
        const auto message = language.messages.find(entry.context);
        const bool is_whole =
            std::ranges::none_of(entry.strings, [](const auto& text) { return text.empty(); });
        if (entry.fuzzy || !is_whole || message == language.messages.end()) {
            continue;
        }
        const auto expected = entry.plural_id.empty() ? 1 : language.plural.forms();
        if (entry.strings.size() != expected) {
            throw InputError{fmt::format("{}:{}: {} translations, expected {}",
                                         file.string(),
                                         entry.line,
                                         entry.strings.size(),
                                         expected)};
        }
        check_places(entry, message->second, file);
        message->second = entry.strings;
    }
    return language;
}

fs::path languages_folder() {
    // From lib/ of a build folder, and from lib/macadam/plugins/ of an installation.
    for (const auto* const place :
         {"../share/macadam/languages", "../../../share/macadam/languages"}) {
        std::error_code missing;
        auto folder = fs::canonical(plugin_path(place), missing);
        if (!missing && fs::exists(folder / template_name)) {
            return folder;
        }
    }
    throw InputError{fmt::format("share/macadam/languages/{} is not beside the program, which "
                                 "takes its words from there; install Macadam again",
                                 template_name)};
}

const std::vector<Language>& installed() {
    static const auto all = [] {
        const auto folder = languages_folder();
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator{folder}) {
            if (entry.path().extension() == ".po") {
                files.push_back(entry.path());
            }
        }
        std::ranges::sort(files);
        std::vector<Language> read{english_of(read_po(folder / template_name))};
        for (const auto& file : files) {
            read.push_back(translated(read.front(), file));
        }
        return read;
    }();
    return all;
}

} // namespace

const Language& english() {
    return installed().front();
}

std::vector<const Language*> languages() {
    std::vector<const Language*> all;
    for (const auto& each : installed()) {
        all.push_back(&each);
    }
    return all;
}

const Language* language(std::string_view code) {
    const auto found = std::ranges::find(installed(), code, &Language::code);
    return found == installed().end() ? nullptr : &*found;
}

const Language& language_from(const fs::path& file) {
    static std::mutex mutex;
    static std::list<Language> read;
    auto language = translated(english(), file);
    const std::scoped_lock lock{mutex};
    return read.emplace_back(std::move(language));
}

const std::string* find_message(const Language& language, std::string_view key, std::size_t n) {
    const auto found = language.messages.find(key);
    if (found == language.messages.end()) {
        return nullptr;
    }
    const auto& forms = found->second;
    return &forms[std::min(language.plural.form(n), forms.size() - 1)];
}

std::string
say(const Language& language, std::string_view key, const Values& values, std::size_t n) {
    const auto* const message = find_message(language, key, n);
    if (message == nullptr) {
        throw std::logic_error{fmt::format("no message '{}' in '{}'", key, language.code)};
    }
    std::string said;
    for (auto rest = std::string_view{*message}; !rest.empty();) {
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
        const auto close = text.find('}', at);
        if (close == std::string_view::npos) {
            throw InputError{fmt::format("'{}' has a '{{' without a '}}', expected a name in "
                                         "brackets",
                                         text)};
        }
        names.emplace_back(text.substr(at + 1, close - at - 1));
    }
    return names;
}

} // namespace macadam
