#include "render/report/document/html.hpp"
#include "render/report/document/page_assets.hpp"
#include "render/report/html/drawing_html.hpp"
#include "render/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {

using namespace document;

namespace {

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
        const auto text = html_of(cell.text);
        // A box of their own: a narrow column would part the swatch from its word.
        return cell.swatch ? fmt::format("<span class=\"entry\">{}<span>{}</span></span>",
                                         swatch_html(*cell.swatch),
                                         text)
                           : text;
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

/// Returns width / height.
double shape_of(const ReportPicture& picture) {
    return static_cast<double>(picture.width_px) / std::max(1, picture.height_px);
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
                            breakable(what),
                            breakable(value),
                            html_of(more));
    }
    return html + "</dl>\n";
}

std::string block_html(const Table& table) {
    return table_html(table, [](const Cell& cell) { return html_of(cell); });
}

std::string block_html(const Legend& legend) {
    auto html = fmt::format("<ul class=\"legend\" aria-label=\"{}\">\n<li class=\"quiet\">{}"
                            "</li>\n",
                            escaped(legend.title),
                            breakable(legend.title));
    for (const auto& [rgb, name, range, dark_rgb] : legend.entries) {
        html += fmt::format(
            "<li>{}{}{}</li>\n",
            rgb ? swatch_html(*rgb, dark_rgb) : "<span class=\"road\"></span>",
            breakable(name),
            range.empty() ? "" : " <span class=\"quiet\">" + breakable(range) + "</span>");
    }
    return html + "</ul>\n";
}

std::string block_html(const MapFigure& map) {
    const auto scale = map.scale_percent > 0
                           ? fmt::format("<span class=\"scale\"><span style=\"width:{:.2f}%\">"
                                         "</span>{}</span>",
                                         map.scale_percent,
                                         breakable(map.scale))
                           : "";
    return fmt::format("<figure class=\"map\" style=\"--shape:{:.3f}\">{}<figcaption>{}{}"
                       "</figcaption></figure>\n",
                       shape_of(map.picture),
                       picture_html(map.picture, map.words),
                       scale,
                       breakable(map.caption));
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
                            breakable(photo.caption));
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
                        breakable(card.title),
                        html_of(card.text),
                        photos_html(card.photos));
    }
    return html + "</div>\n";
}

std::string block_html(const Overview& overview) {
    return fmt::format("<div class=\"overview\" style=\"--shape:{:.3f}\">{}{}{}</div>\n",
                       shape_of(overview.map.picture),
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
                       breakable(section.title),
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
            "<li><a href=\"#section-{}\">{}</a></li>\n", ++number, breakable(section.title));
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
            "<footer>\n<h2>{}</h2>\n{}</footer>\n", breakable(section.title), blocks_html(section));
    }
    return html + fmt::format("<script>{}</script>\n</body>\n</html>\n", page_script());
}

} // namespace macadam
