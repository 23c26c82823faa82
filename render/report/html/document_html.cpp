#include "render/report/document/html.hpp"
#include "render/report/document/page_assets.hpp"
#include "render/report/html/drawing_html.hpp"
#include "render/report/report.hpp"
#include "render/scene/unbroken_numbers.hpp"

#include "estimator/common/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {

using namespace document;

namespace {

/// Tests whether a break may be added before a letter. Marks belong to the letter before them; the
/// scripts from Hebrew on have marks, joined letters, or words without spaces, where pages break
/// them by rules of their own.
bool may_follow_break(char32_t letter) {
    constexpr char32_t first_mark = 0x300, last_mark = 0x36F, hebrew = 0x590;
    return letter < hebrew && !(first_mark <= letter && letter <= last_mark);
}

/// Escapes text and allows breaks only in words longer than a column; '\n' becomes a break.
std::string breakable(std::string_view of) {
    constexpr std::size_t longest_word = 24; // letters
    const auto unbroken = with_unbroken_numbers(of);
    std::string_view text{unbroken};
    std::string html, piece;
    std::size_t letters = 0;
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
        letters = text.front() == ' ' ? 0 : letters + 1;
        if (letters > longest_word && may_follow_break(utf8_letter(text.substr(0, length)))) {
            flush();
            html += "<wbr>";
            letters = 1;
        }
        piece += text.substr(0, length);
        text.remove_prefix(length);
    }
    flush();
    return html;
}

std::string html_of(const Span& span) {
    auto html = breakable(span.text);
    if (!span.target.empty()) {
        html = fmt::format("<a href=\"#{}\">{}</a>", escaped(span.target), html);
    }
    if (!span.address.empty()) {
        html = fmt::format(
            "<a rel=\"noopener noreferrer\" href=\"{}\">{}</a>", escaped(span.address), html);
    }
    if (span.unbroken) {
        html = "<span class=\"nw\">" + html + "</span>";
    }
    switch (span.look) {
    case SpanLook::strong:
        return "<b>" + html + "</b>";
    case SpanLook::quiet:
        return "<span class=\"quiet\">" + html + "</span>";
    case SpanLook::phone:
        return "<span class=\"phone\">" + html + "</span>";
    case SpanLook::plain:
        break;
    }
    return html;
}

std::string html_of(const RichText& rich) {
    std::string html;
    for (const auto& span : rich.spans) {
        html += html_of(span);
    }
    return html;
}

std::string words_of(const RichText& rich) {
    std::string words;
    for (const auto& span : rich.spans) {
        words += span.text;
    }
    return words;
}

/// Returns a small coloured square, hidden from screen readers.
/// \param dark_rgb  on dark pages; `std::nullopt`: the same
std::string swatch_html(std::uint32_t rgb, std::optional<std::uint32_t> dark_rgb = {}) {
    const auto square = [](const char* pages, std::uint32_t colour) {
        return fmt::format(
            "<rect class=\"bar{}\" width=\"10\" height=\"10\" fill=\"#{:06x}\"/>", pages, colour);
    };
    return fmt::format("<svg class=\"swatch\" viewBox=\"0 0 10 10\" aria-hidden=\"true\">{}</svg>",
                       dark_rgb ? square(" light", rgb) + square(" dark", *dark_rgb)
                                : square("", rgb));
}

std::string html_of(const Cell& cell) {
    if (cell.shares.empty()) {
        return (cell.swatch ? swatch_html(*cell.swatch) : "") + html_of(cell.text);
    }
    std::string bars;
    double x = 0;
    for (const auto& [percent, rgb] : cell.shares) {
        if (percent > 0) {
            bars += fmt::format("<rect x=\"{:.2f}\" width=\"{:.2f}\" height=\"10\" "
                                "fill=\"#{:06x}\"/>",
                                x,
                                percent,
                                rgb);
        }
        x += percent;
    }
    return fmt::format("<svg class=\"share\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" "
                       "role=\"img\" aria-label=\"{}\">{}</svg>",
                       escaped(words_of(cell.text)),
                       bars);
}

std::string picture_html(const ReportPicture& picture, const std::string& words) {
    const auto image = [&](const char* look, const std::vector<std::uint8_t>& png) {
        return fmt::format("<img{} width=\"{}\" height=\"{}\" alt=\"{}\" "
                           "src=\"data:image/png;base64,{}\">",
                           look,
                           picture.width_px,
                           picture.height_px,
                           escaped(words),
                           base64(png));
    };
    return picture.dark_png.empty() ? image("", picture.light_png)
                                    : image(" class=\"light\"", picture.light_png) +
                                          image(" class=\"dark\"", picture.dark_png);
}

// --------------------------------------------------------------------------------------- blocks

std::string block_html(const Paragraph& paragraph) {
    return fmt::format(
        "<p{}>{}</p>\n", paragraph.small ? " class=\"small quiet\"" : "", html_of(paragraph.text));
}

std::string block_html(const Bullets& bullets) {
    std::string html = "<ul>\n";
    for (const auto& item : bullets.items) {
        html += "<li>" + html_of(item) + "</li>\n";
    }
    return html + "</ul>\n";
}

std::string block_html(const KeyNumbers& keys) {
    std::string html = "<dl class=\"key\">\n";
    for (const auto& [what, value, more] : keys.numbers) {
        html += fmt::format("<div><dt>{}</dt><dd><b>{}</b><span>{}</span></dd></div>\n",
                            escaped(what),
                            escaped(with_unbroken_numbers(value)),
                            html_of(more));
    }
    return html + "</dl>\n";
}

std::string block_html(const Table& table) {
    return table_html(table, [](const Cell& cell) { return html_of(cell); });
}

std::string block_html(const Legend& legend) {
    auto html = fmt::format("<ul class=\"legend\" aria-label=\"{0}\">\n<li class=\"quiet\">{0}"
                            "</li>\n",
                            escaped(legend.title));
    for (const auto& [rgb, name, range, dark_rgb] : legend.entries) {
        html += fmt::format("<li>{}{}{}</li>\n",
                            rgb ? swatch_html(*rgb, dark_rgb) : "<span class=\"road\"></span>",
                            escaped(name),
                            range.empty() ? ""
                                          : " <span class=\"quiet\">" + escaped(range) + "</span>");
    }
    return html + "</ul>\n";
}

std::string block_html(const MapFigure& map) {
    const auto scale = map.scale_percent > 0
                           ? fmt::format("<span class=\"scale\"><span style=\"width:{:.2f}%\">"
                                         "</span>{}</span>",
                                         map.scale_percent,
                                         escaped(map.scale))
                           : "";
    return fmt::format("<figure class=\"map\" style=\"--shape:{:.3f}\">{}<figcaption>{}{}"
                       "</figcaption></figure>\n",
                       static_cast<double>(map.picture.width_px) /
                           std::max(1, map.picture.height_px),
                       picture_html(map.picture, map.words),
                       scale,
                       escaped(map.caption));
}

/// Returns the photos of a card; "" without any.
std::string photos_html(const std::vector<Photo>& photos) {
    if (photos.empty()) {
        return {};
    }
    std::string html = "<div class=\"photos\">\n";
    for (const auto& photo : photos) {
        html += fmt::format("<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" "
                            "src=\"data:image/jpeg;base64,{}\"><figcaption>{}</figcaption>"
                            "</figure>\n",
                            photo.width_px,
                            photo.height_px,
                            escaped(photo.words),
                            base64(photo.jpeg),
                            escaped(photo.caption));
    }
    return html + "</div>\n";
}

std::string block_html(const Photos& photos) {
    return photos_html(photos.photos);
}

std::string block_html(const Cards& cards) {
    std::string html = "<div class=\"cards\">\n";
    for (const auto& card : cards.cards) {
        html +=
            fmt::format("<figure id=\"{}\">{}{}<figcaption><h3>{}</h3>{}</figcaption>{}</figure>\n",
                        escaped(card.id),
                        picture_html(card.picture, card.words),
                        card.chart ? block_html(*card.chart) : "",
                        escaped(card.title),
                        html_of(card.text),
                        photos_html(card.photos));
    }
    return html + "</div>\n";
}

std::string block_html(const Overview& overview) {
    return fmt::format("<div class=\"overview\"><div>{}{}</div>{}</div>\n",
                       block_html(overview.legend),
                       block_html(overview.map),
                       overview.distribution ? block_html(*overview.distribution) : "");
}

std::string blocks_html(const DocumentSection& section) {
    std::string html;
    for (const auto& block : section.blocks) {
        html += std::visit([](const auto& of) { return block_html(of); }, block);
    }
    return html;
}

/// Returns a section that readers can fold; phones show it folded, if scripts run.
std::string section_html(const DocumentSection& section, std::size_t number) {
    return fmt::format("<section><details open id=\"section-{}\"><summary><h2>{}</h2></summary>\n{}"
                       "</details></section>\n",
                       number,
                       escaped(section.title),
                       blocks_html(section));
}

std::string contents_html(const Document& document) {
    if (document.words.contents.empty()) {
        return {};
    }
    auto html = fmt::format("<nav aria-label=\"{}\"><ol>\n", escaped(document.words.contents));
    std::size_t number = 0;
    for (const auto& section : document.sections) {
        html += fmt::format(
            "<li><a href=\"#section-{}\">{}</a></li>\n", ++number, escaped(section.title));
    }
    return html + "</ol></nav>\n";
}

std::string head_html(const Document& document) {
    // The content security policy guarantees that the page loads no external resources and that no
    // script runs but the page's own.
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "style-src 'unsafe-inline'; img-src data:; script-src 'sha256-{}'; base-uri 'none'; "
        "form-action 'none'\">\n"
        "<meta name=\"generator\" content=\"Macadam\">\n<title>{}</title>\n<style>\n{}</style>\n"
        "</head>\n<body data-csv=\"{}\" data-sort=\"{}\" data-mark=\"{}\">\n",
        escaped(document.language),
        page_script_sha256,
        escaped(document.title),
        report_style(),
        escaped(document.words.download_csv),
        escaped(document.words.sort_by),
        escaped(document.words.decimal_mark));
}

} // namespace

std::string html_of(const Document& document) {
    auto html =
        head_html(document) + fmt::format("<header>\n<h1>{}</h1>\n<p class=\"quiet\">{}</p>\n",
                                          breakable(document.title),
                                          html_of(document.subtitle));
    if (!document.lead.spans.empty()) {
        html += fmt::format("<p class=\"lead\">{}</p>\n", html_of(document.lead));
    }
    if (!document.keys.numbers.empty()) {
        html += block_html(document.keys);
    }
    html += document.overview ? block_html(*document.overview) : "";
    html += "</header>\n" + contents_html(document) + "<main>\n";
    std::size_t number = 0;
    for (const auto& section : document.sections) {
        html += section_html(section, ++number);
    }
    html += "</main>\n";
    for (const auto& section : document.end) {
        html += fmt::format(
            "<footer>\n<h2>{}</h2>\n{}</footer>\n", escaped(section.title), blocks_html(section));
    }
    return html + fmt::format("<script>{}</script>\n</body>\n</html>\n", page_script());
}

} // namespace macadam
