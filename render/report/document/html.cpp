#include "render/report/document/html.hpp"

#include "estimator/common/utf8.hpp"
#include "render/scene/isolated_text.hpp"
#include "render/scene/unbroken_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD"; // U+FFFD

std::string_view as_html(char c, std::string_view itself) {
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? " " : itself;
    }
}

/// Tests whether a break may be added before a letter. Marks belong to the letter before them; the
/// scripts from Hebrew on have marks, joined letters, or words without spaces, where pages break
/// them by rules of their own.
bool may_follow_break(char32_t letter) {
    constexpr char32_t first_mark = 0x300, last_mark = 0x36F, hebrew = 0x590;
    return letter < hebrew && !(first_mark <= letter && letter <= last_mark);
}

} // namespace

std::string escaped(std::string_view text) {
    std::string html;
    html.reserve(text.size());
    while (!text.empty()) {
        const auto length = utf8_length(text);
        if (length == 0) {
            html += replacement;
        } else if (length == 1) {
            html += as_html(text.front(), text.substr(0, 1));
        } else if (!is_bidi_control(utf8_letter(text.substr(0, length)))) {
            html += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(1, length));
    }
    return html;
}

std::string breakable(std::string_view of) {
    constexpr std::size_t longest_word = 24; // letters
    const auto unbroken = with_unbroken_numbers(of);
    std::string_view text{unbroken};
    std::string html, piece;
    std::size_t letters = 0;
    int isolates = 0; // that are open
    const auto flush = [&] {
        html += escaped(piece);
        piece.clear();
    };
    while (!text.empty()) {
        const auto length = std::max<std::size_t>(1, utf8_length(text));
        if (text.front() == '\n') {
            flush();
            html += "<br>";
            letters = 0;
            text.remove_prefix(1);
            continue;
        }
        const auto letter = utf8_letter(text.substr(0, length));
        if (letter == isolate_begin || (letter == isolate_end && isolates > 0)) {
            flush();
            html += letter == isolate_begin ? "<bdi>" : "</bdi>";
            isolates += letter == isolate_begin ? 1 : -1;
            text.remove_prefix(length);
            continue;
        }
        if (const auto unit = slashed_unit_at_start(text); unit > 0) {
            flush();
            html += fmt::format("<span class=\"nw\">{}</span>", text.substr(0, unit));
            letters += unit;
            text.remove_prefix(unit);
            continue;
        }
        letters = text.front() == ' ' ? 0 : letters + 1;
        if (letters > longest_word && may_follow_break(letter)) {
            flush();
            html += "<wbr>";
            letters = 1;
        }
        piece += text.substr(0, length);
        text.remove_prefix(length);
    }
    flush();
    for (; isolates > 0; --isolates) {
        html += "</bdi>";
    }
    return html;
}

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) -> std::uint32_t {
            return i + k < bytes.size() ? bytes[i + k] : 0;
        };
        const std::uint32_t group = byte(0) << 16U | byte(1) << 8U | byte(2);
        const auto known = std::min<std::size_t>(3, bytes.size() - i) + 1;
        for (std::size_t k = 0; k < 4; ++k) {
            text += k < known ? digits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

std::string table_html(const document::Table& table,
                       const std::function<std::string(const document::Cell&)>& cell_html) {
    const auto class_of = [&](std::size_t column) {
        const auto& [title, number, elsewhere] = table.columns[column];
        return number && elsewhere ? " class=\"n else\"" : number ? " class=\"n\"" : "";
    };
    const auto title_of = [&](std::size_t column) {
        return table.stacks ? fmt::format(" data-t=\"{}\"", escaped(table.columns[column].title))
                            : std::string{};
    };
    constexpr std::size_t rows_that_stay_together = 12; // on paper; longer tables are split
    constexpr std::size_t most_on_a_phone = 8;          // columns, with a margin for a tablet
    const auto* const kind = table.rows.size() > rows_that_stay_together ? "wide long" : "wide";
    auto html = fmt::format("<div class=\"{}\" role=\"region\" aria-label=\"{}\" "
                            "tabindex=\"0\"><table{}>\n<caption>{}</caption>\n<thead><tr>",
                            kind,
                            escaped(table.caption),
                            !table.stacks                            ? ""
                            : table.columns.size() > most_on_a_phone ? " class=\"stack many\""
                                                                     : " class=\"stack\"",
                            breakable(table.caption));
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        html += fmt::format(
            "<th scope=\"col\"{}>{}</th>", class_of(i), breakable(table.columns[i].title));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
        const bool sum = table.sum && &row == &table.rows.back();
        html += sum ? "<tr class=\"all\">" : "<tr>";
        html += fmt::format("<th scope=\"row\"{}>{}</th>", class_of(0), cell_html(row.front()));
        for (std::size_t i = 1; i < row.size(); ++i) {
            html += fmt::format("<td{}{}>{}</td>", class_of(i), title_of(i), cell_html(row[i]));
        }
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table></div>\n";
}

} // namespace macadam
