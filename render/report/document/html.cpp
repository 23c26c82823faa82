#include "render/report/document/html.hpp"

#include "estimator/common/utf8.hpp"

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
    auto html = fmt::format("<div class=\"{1}\" role=\"region\" aria-label=\"{0}\" "
                            "tabindex=\"0\"><table{2}>\n<caption>{0}</caption>\n<thead><tr>",
                            escaped(table.caption),
                            kind,
                            !table.stacks                            ? ""
                            : table.columns.size() > most_on_a_phone ? " class=\"stack many\""
                                                                     : " class=\"stack\"");
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        html += fmt::format(
            "<th scope=\"col\"{}>{}</th>", class_of(i), escaped(table.columns[i].title));
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
