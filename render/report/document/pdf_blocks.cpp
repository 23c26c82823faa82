#include "render/report/document/pdf_blocks.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace macadam {

using namespace document;

namespace {

constexpr double bullet_indent_pt = 10;
constexpr std::size_t keys_in_a_row = 5;
constexpr double card_gap_pt = 12;
constexpr double card_picture_share = 0.49; // of the width; the text is beside
constexpr double min_chart_share = 0.75; // of the text's width, so that the picture sets the height
constexpr double chart_air_pt = 4;       // above a card's chart
constexpr int photos_in_a_row = 4;
constexpr double photo_gap_pt = 5;
constexpr double key_padding_pt = 7;
constexpr double legend_gap_pt = 14;
constexpr double swatch_pt = 7;
constexpr double max_line_pt = 440; // of running text: longer lines are hard to read
constexpr double scale_height_pt = 4;
constexpr double room_over_map_pt = 80; // for heading and legend

PdfType body() {
    return {.size_pt = body_size_pt};
}

PdfType remark() {
    return {.size_pt = small_size_pt, .rgb = print::quiet};
}

double line_width(const PdfSheets& sheets) {
    return std::min(sheets.width_pt(), max_line_pt);
}

/// Content of a key number's box.
struct Key {
    PdfText what, value, more;

    double height_pt() const {
        return what.height_pt() + value.height_pt() + more.height_pt() + 2 * key_padding_pt;
    }
};

/// Layout of a card: a picture, beside it text and chart, and photos below.
struct CardLayout {
    PdfText title, text;
    double picture_width_pt, text_width_pt, chart_width_pt;
    double picture_pt, chart_pt, photos_pt; ///< heights

    double top_pt() const {
        return std::max(picture_pt, title.height_pt() + text.height_pt() + chart_pt);
    }
    double height_pt() const { return top_pt() + photos_pt; }
};

/// Photos of a card in a row, with captions below.
struct PhotoRow {
    std::vector<PdfText> captions;
    double width_pt;  ///< of a photo
    double height_pt; ///< of the row with the gap above
};

/// Returns the size of a photo in a row, of which none is more than half as high again as it has
/// room in width.
std::pair<double, double> size_pt(const Photo& photo, double row_width_pt) {
    constexpr double max_shape = 1.5;
    const double shape = static_cast<double>(photo.height_px) / std::max(1, photo.width_px);
    const double width_pt = row_width_pt * std::min(1.0, max_shape / shape);
    return {width_pt, width_pt * shape};
}

PhotoRow lay_out(const PdfSheets& sheets, const std::vector<Photo>& photos, double width_pt) {
    PhotoRow row{{}, (width_pt - photo_gap_pt * (photos_in_a_row - 1)) / photos_in_a_row, 0};
    for (const auto& photo : photos) {
        row.captions.push_back(sheets.text(
            photo.caption, {.size_pt = small_size_pt - 1.5, .rgb = print::quiet}, row.width_pt));
        row.height_pt = std::max(row.height_pt,
                                 photo_gap_pt + size_pt(photo, row.width_pt).second +
                                     row.captions.back().height_pt());
    }
    return row;
}

void put_photos(PdfSheets& sheets,
                const std::vector<Photo>& photos,
                const PhotoRow& row,
                double x_pt,
                double y_pt) {
    y_pt += photo_gap_pt;
    for (std::size_t i = 0; i < photos.size(); ++i) {
        const auto [shown_pt, height_pt] = size_pt(photos[i], row.width_pt);
        {
            const PdfFigure figure{sheets, photos[i].words};
            sheets.photo(photos[i], x_pt, y_pt, shown_pt);
        }
        const PdfElement caption{sheets, "P"};
        sheets.draw(row.captions[i], x_pt, y_pt + height_pt);
        x_pt += row.width_pt + photo_gap_pt;
    }
}

PdfText lay_out(const PdfSheets& sheets, const Paragraph& paragraph) {
    return sheets.text(paragraph.text, paragraph.small ? remark() : body(), line_width(sheets));
}

/// Map at the largest size that fits the page.
struct MapLayout {
    PdfText caption, scale;
    double width_pt, height_pt; ///< of the picture

    double whole_pt() const { return height_pt + 6 + scale.height_pt() + caption.height_pt(); }
};

/// \param max_width_pt  room for it
MapLayout lay_out(const PdfSheets& sheets, const MapFigure& map, double max_width_pt) {
    MapLayout layout{sheets.text(map.caption, remark(), max_width_pt),
                     sheets.text(map.scale, {.size_pt = small_size_pt}, -1),
                     0,
                     0};
    const double shape =
        static_cast<double>(map.picture.height_px) / std::max(1, map.picture.width_px);
    const double room_pt = sheets.height_pt() - layout.whole_pt() - room_over_map_pt;
    layout.width_pt = std::min(max_width_pt, room_pt / shape);
    layout.height_pt = layout.width_pt * shape;
    return layout;
}

/// Returns the height below which a map goes to the next page rather than become smaller: a page
/// that it leaves is hardly a third empty.
double least_pt(const MapLayout& layout) {
    constexpr double min_map_pt = 140;
    return layout.whole_pt() - layout.height_pt + std::min(layout.height_pt, min_map_pt);
}

void shrink(MapLayout& layout, double max_height_pt) {
    if (layout.height_pt > max_height_pt) {
        layout.width_pt *= max_height_pt / layout.height_pt;
        layout.height_pt = max_height_pt;
    }
}

void put_map(PdfSheets& sheets, const MapFigure& map, const MapLayout& layout) {
    const auto& [caption, scale, width_pt, height_pt] = layout;
    {
        const PdfFigure figure{sheets, map.words};
        sheets.picture(map.picture, sheets.left_pt(), sheets.y_pt(), width_pt);
    }
    sheets.skip(height_pt + 4);
    if (map.scale_percent > 0) {
        const double bar_pt = width_pt * map.scale_percent / 100;
        const double y_pt = sheets.y_pt() + scale.height_pt() / 2 - scale_height_pt / 2;
        sheets.fill(print::ink, sheets.left_pt(), y_pt + scale_height_pt - 1, bar_pt, 1);
        sheets.fill(print::ink, sheets.left_pt(), y_pt, 1, scale_height_pt);
        sheets.fill(print::ink, sheets.left_pt() + bar_pt - 1, y_pt, 1, scale_height_pt);
        const PdfElement element{sheets, "P"};
        sheets.draw(scale, sheets.left_pt() + bar_pt + 6, sheets.y_pt());
        sheets.skip(scale.height_pt());
    }
    const PdfElement element{sheets, "Caption"};
    sheets.draw(caption, sheets.left_pt(), sheets.y_pt());
    sheets.skip(caption.height_pt() + block_gap_pt);
}

} // namespace

double first_pt(const PdfSheets& sheets, const Paragraph& paragraph) {
    return lay_out(sheets, paragraph).height_pt();
}

double first_pt(const PdfSheets& sheets, const MapFigure& map) {
    return least_pt(lay_out(sheets, map, sheets.width_pt()));
}

void put(PdfSheets& sheets, const Paragraph& paragraph) {
    const auto text = lay_out(sheets, paragraph);
    sheets.need(std::min(text.height_pt(), sheets.height_pt()));
    const PdfElement element{sheets, "P"};
    sheets.draw(text, sheets.left_pt(), sheets.y_pt());
    sheets.skip(text.height_pt() + block_gap_pt * 0.7);
}

void put(PdfSheets& sheets, const Bullets& bullets) {
    const PdfElement list{sheets, "L"};
    for (const auto& item : bullets.items) {
        const auto text = sheets.text(item, body(), line_width(sheets) - bullet_indent_pt);
        sheets.need(std::min(text.height_pt(), sheets.height_pt()));
        const PdfElement entry{sheets, "LI"};
        {
            const PdfElement label{sheets, "Lbl"};
            sheets.draw(sheets.text("•", body(), -1), sheets.left_pt(), sheets.y_pt());
        }
        const PdfElement content{sheets, "LBody"};
        sheets.draw(text, sheets.left_pt() + bullet_indent_pt, sheets.y_pt());
        sheets.skip(text.height_pt() + 3);
    }
    sheets.skip(block_gap_pt);
}

void put(PdfSheets& sheets, const KeyNumbers& keys) {
    const double gap_pt = 8;
    const double width_pt =
        (sheets.width_pt() - gap_pt * (keys_in_a_row - 1)) / static_cast<double>(keys_in_a_row);
    const double text_pt = width_pt - 2 * key_padding_pt;
    for (std::size_t i = 0; i < keys.numbers.size(); i += keys_in_a_row) {
        std::vector<Key> row;
        double height_pt = 0;
        for (auto k = i; k < std::min(i + keys_in_a_row, keys.numbers.size()); ++k) {
            const auto& [what, value, more] = keys.numbers[k];
            row.push_back({sheets.text(what, remark(), text_pt),
                           sheets.text(value, {.size_pt = 12, .bold = true}, text_pt),
                           sheets.text(more, remark(), text_pt)});
            height_pt = std::max(height_pt, row.back().height_pt());
        }
        sheets.need(height_pt);
        double x_pt = sheets.left_pt();
        for (const auto& key : row) {
            sheets.frame(print::border, x_pt, sheets.y_pt(), width_pt, height_pt);
            double y_pt = sheets.y_pt() + key_padding_pt;
            const PdfElement element{sheets, "P"};
            for (const auto* const text : {&key.what, &key.value, &key.more}) {
                sheets.draw(*text, x_pt + key_padding_pt, y_pt);
                y_pt += text->height_pt();
            }
            x_pt += width_pt + gap_pt;
        }
        sheets.skip(height_pt + gap_pt);
    }
    sheets.skip(block_gap_pt / 2);
}

void put(PdfSheets& sheets, const Legend& legend) {
    const auto title = sheets.text(legend.title, remark(), -1);
    sheets.need(2 * title.height_pt());
    double x_pt = sheets.left_pt();
    {
        const PdfElement element{sheets, "P"};
        sheets.draw(title, x_pt, sheets.y_pt());
    }
    x_pt += title.width_pt() + legend_gap_pt;
    for (const auto& [rgb, name, range, dark_rgb] : legend.entries) {
        const RichText words{{{name}, {range.empty() ? "" : " " + range, SpanLook::quiet}}};
        const auto text = sheets.text(words, {.size_pt = small_size_pt}, -1);
        const double width_pt = swatch_pt + 4 + text.width_pt();
        if (x_pt + width_pt > sheets.left_pt() + sheets.width_pt()) {
            x_pt = sheets.left_pt();
            sheets.skip(text.height_pt() + 2);
        }
        const double middle_pt = sheets.y_pt() + text.height_pt() / 2;
        if (rgb) {
            sheets.fill(*rgb, x_pt, middle_pt - swatch_pt / 2, swatch_pt, swatch_pt);
            sheets.frame(print::edge, x_pt, middle_pt - swatch_pt / 2, swatch_pt, swatch_pt);
        } else {
            sheets.fill(print::border, x_pt, middle_pt - 0.75, swatch_pt, 1.5);
        }
        const PdfElement element{sheets, "P"};
        sheets.draw(text, x_pt + swatch_pt + 4, sheets.y_pt());
        x_pt += width_pt + legend_gap_pt;
    }
    sheets.skip(title.height_pt() + block_gap_pt / 2);
}

void put(PdfSheets& sheets, const MapFigure& map) {
    auto layout = lay_out(sheets, map, sheets.width_pt());
    sheets.need(least_pt(layout));
    shrink(layout, sheets.room_pt() - (layout.whole_pt() - layout.height_pt));
    put_map(sheets, map, layout);
}

void put(PdfSheets& sheets, const Overview& overview) {
    constexpr double min_map_pt = 200; // of height: on a page of its own rather than smaller
    put(sheets, overview.legend);
    if (!overview.wide_distribution) {
        put(sheets, overview.map);
        return;
    }
    const auto& chart = *overview.wide_distribution;
    const double chart_height_pt = sheets.width_pt() * chart.height / chart.width;
    auto layout = lay_out(sheets, overview.map, sheets.width_pt());
    const double below_pt =
        layout.whole_pt() - layout.height_pt + chart_height_pt + 2 * block_gap_pt;
    sheets.need(std::min(layout.height_pt, min_map_pt) + below_pt);
    shrink(layout, sheets.room_pt() - below_pt);
    put_map(sheets, overview.map, layout);
    draw_at(sheets, chart, sheets.left_pt(), sheets.y_pt(), sheets.width_pt());
    sheets.skip(chart_height_pt + block_gap_pt);
}

namespace {

CardLayout lay_out(const PdfSheets& sheets, const Card& card) {
    const double picture_width_pt = card_picture_share * (sheets.width_pt() - card_gap_pt);
    const double text_width_pt = sheets.width_pt() - card_gap_pt - picture_width_pt;
    CardLayout of{
        .title = sheets.text(card.title, {.size_pt = small_size_pt, .bold = true}, text_width_pt),
        .text = sheets.text(card.text, {.size_pt = small_size_pt - 0.5}, text_width_pt),
        .picture_width_pt = picture_width_pt,
        .text_width_pt = text_width_pt,
        .chart_width_pt = 0,
        .picture_pt =
            picture_width_pt * card.picture.height_px / std::max(1, card.picture.width_px),
        .chart_pt = 0,
        .photos_pt = lay_out(sheets, card.photos, sheets.width_pt()).height_pt};
    if (card.chart) {
        const double shape = card.chart->height / card.chart->width;
        const double room_pt =
            of.picture_pt - of.title.height_pt() - of.text.height_pt() - chart_air_pt;
        of.chart_width_pt =
            std::clamp(room_pt / shape, min_chart_share * text_width_pt, text_width_pt);
        of.chart_pt = chart_air_pt + of.chart_width_pt * shape;
    }
    return of;
}

void put_card(PdfSheets& sheets, const Card& card, const CardLayout& of) {
    const double x_pt = sheets.left_pt() + of.picture_width_pt + card_gap_pt;
    double y_pt = sheets.y_pt();
    {
        const PdfElement title{sheets, "H3"};
        sheets.draw(of.title, x_pt, y_pt);
    }
    y_pt += of.title.height_pt();
    {
        const PdfFigure figure{sheets, card.words};
        sheets.picture(card.picture, sheets.left_pt(), sheets.y_pt(), of.picture_width_pt);
    }
    {
        const PdfElement text{sheets, "P"};
        sheets.draw(of.text, x_pt, y_pt);
    }
    if (card.chart) {
        draw_at(sheets,
                *card.chart,
                x_pt,
                y_pt + of.text.height_pt() + chart_air_pt,
                of.chart_width_pt);
    }
    put_photos(sheets,
               card.photos,
               lay_out(sheets, card.photos, sheets.width_pt()),
               sheets.left_pt(),
               sheets.y_pt() + of.top_pt());
}

} // namespace

void put(PdfSheets& sheets, const Photos& photos) {
    const auto row = lay_out(sheets, photos.photos, sheets.width_pt());
    sheets.need(std::min(row.height_pt, sheets.height_pt()));
    put_photos(sheets, photos.photos, row, sheets.left_pt(), sheets.y_pt());
    sheets.skip(row.height_pt + block_gap_pt);
}

void put(PdfSheets& sheets, const Cards& cards) {
    for (const auto& card : cards.cards) {
        const auto layout = lay_out(sheets, card);
        sheets.need(std::min(layout.height_pt(), sheets.height_pt()));
        sheets.place(card.id, sheets.y_pt());
        put_card(sheets, card, layout);
        sheets.skip(layout.height_pt() + card_gap_pt);
    }
}

} // namespace macadam
