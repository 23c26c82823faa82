#include "render/report/words/po_file.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_bytes = 4'000'000;
constexpr std::size_t max_forms = 6;

/// Line of the file: a keyword ("" if the line continues a string) and its string.
struct PoLine {
    std::string_view keyword;
    std::string text;
};

class PoParser {
public:
    PoParser(std::string_view text, std::string_view name) : rest_{text}, name_{name} {}

    std::vector<PoEntry> entries() {
        while (!rest_.empty()) {
            take_line();
        }
        finish_entry();
        return std::move(entries_);
    }

private:
    [[noreturn]] void refuse(std::string_view there, std::string_view expected) const {
        throw InputError{fmt::format("{}:{}: {}, expected {}", name_, line_, there, expected)};
    }

    void take_line() {
        ++line_;
        const auto end = std::min(rest_.find('\n'), rest_.size());
        auto line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.empty()) {
            return;
        }
        if (line.front() == '#') {
            take_comment(line);
            return;
        }
        put(parsed(line));
    }

    void take_comment(std::string_view line) {
        if (line.starts_with("#~")) {
            return;
        }
        if (!entry_.strings.empty()) {
            finish_entry();
        }
        fuzzy_ = fuzzy_ || (line.starts_with("#,") && line.find("fuzzy") != std::string_view::npos);
    }

    PoLine parsed(std::string_view line) const {
        const auto quote = line.find('"');
        if (quote == std::string_view::npos || line.size() < quote + 2 || line.back() != '"') {
            refuse(fmt::format("'{}'", line.substr(0, 60)), "a keyword and a quoted string");
        }
        auto keyword = line.substr(0, quote);
        keyword = keyword.substr(0, keyword.find_last_not_of(" \t") + 1);
        return {keyword, unquoted(line.substr(quote + 1, line.size() - quote - 2))};
    }

    std::string unquoted(std::string_view quoted) const {
        std::string text;
        while (!quoted.empty()) {
            const auto length = utf8_length(quoted);
            const char c = quoted.front();
            if (length == 0) {
                refuse("bytes that are not UTF-8", "UTF-8");
            }
            if (c == '"' || (length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7F))) {
                refuse("a quote or a control character within a string", "\\\" or \\n");
            }
            if (c == '\\') {
                text += escaped_letter(quoted.substr(1));
                quoted.remove_prefix(2);
                continue;
            }
            text += quoted.substr(0, length);
            quoted.remove_prefix(length);
        }
        return text;
    }

    char escaped_letter(std::string_view rest) const {
        switch (rest.empty() ? '\0' : rest.front()) {
        case 'n':
            return '\n';
        case 't':
            return ' ';
        case '"':
            return '"';
        case '\\':
            return '\\';
        default:
            refuse(fmt::format("'\\{}'", rest.substr(0, 1)), "\\n, \\t, \\\" or \\\\");
        }
    }

    void put(const PoLine& line) {
        if (line.keyword.empty()) {
            if (!target_) {
                refuse("a string without a keyword", "msgctxt, msgid or msgstr before it");
            }
            string_of(*target_) += line.text;
            return;
        }
        const auto index = index_of(line.keyword);
        if (line.keyword == "msgctxt" || (line.keyword == "msgid" && target_ != Target::context)) {
            finish_entry();
        }
        if (line.keyword == "msgctxt") {
            target_ = Target::context;
        } else if (line.keyword == "msgid") {
            target_ = Target::id;
            entry_.line = line_;
            is_open_ = true;
        } else if (line.keyword == "msgid_plural") {
            target_ = Target::plural_id;
        } else if (index && is_open_) {
            if (*index != entry_.strings.size()) {
                refuse(fmt::format("'{}'", line.keyword),
                       fmt::format("msgstr[{}]", entry_.strings.size()));
            }
            entry_.strings.emplace_back();
            target_ = Target::string;
        } else {
            refuse(fmt::format("'{}'", line.keyword.substr(0, 60)),
                   "msgctxt, msgid, msgid_plural or, after a msgid, msgstr");
        }
        string_of(*target_) += line.text;
    }

    /// Returns the number of a translation: 0 for "msgstr", 2 for "msgstr[2]".
    static std::optional<std::size_t> index_of(std::string_view keyword) {
        constexpr std::string_view begin = "msgstr[";
        if (keyword == "msgstr") {
            return 0;
        }
        if (keyword.size() == begin.size() + 2 && keyword.starts_with(begin) &&
            keyword.back() == ']' && '0' <= keyword[begin.size()] &&
            keyword[begin.size()] < static_cast<char>('0' + max_forms)) {
            return static_cast<std::size_t>(keyword[begin.size()] - '0');
        }
        return std::nullopt;
    }

    enum class Target { context, id, plural_id, string };

    std::string& string_of(Target target) {
        switch (target) {
        case Target::context:
            return entry_.context;
        case Target::id:
            return entry_.id;
        case Target::plural_id:
            return entry_.plural_id;
        case Target::string:
            break;
        }
        return entry_.strings.back();
    }

    void finish_entry() {
        if (!is_open_) {
            return;
        }
        if (entry_.strings.empty()) {
            throw InputError{
                fmt::format("{}:{}: a msgid without a msgstr, expected both", name_, entry_.line)};
        }
        entry_.fuzzy = fuzzy_;
        entries_.push_back(std::move(entry_));
        entry_ = {};
        fuzzy_ = false;
        is_open_ = false;
        target_.reset();
    }

    std::string_view rest_;
    std::string_view name_;
    std::size_t line_ = 0;
    std::vector<PoEntry> entries_;
    PoEntry entry_;
    std::optional<Target> target_;
    bool is_open_ = false;
    bool fuzzy_ = false; ///< said by a comment before the entry
};

} // namespace

std::vector<PoEntry> parse_po(std::string_view text, std::string_view name) {
    if (text.size() > max_bytes) {
        throw InputError{fmt::format(
            "{}: {} bytes, expected at most {} for a catalogue", name, text.size(), max_bytes)};
    }
    if (text.starts_with("\xEF\xBB\xBF")) {
        text.remove_prefix(3);
    }
    return PoParser{text, name}.entries();
}

} // namespace macadam
