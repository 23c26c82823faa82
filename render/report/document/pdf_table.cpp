#include "render/report/document/pdf_blocks.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

namespace macadam {

using namespace document;

namespace {

constexpr std::array sizes_pt{8.0, 7.5, 7.0, 6.5, 6.0}; // the first that fits all columns is used
constexpr double gap_pt = 9;                            // between columns
constexpr double padding_pt = 2.6;                      // above and below the text of a row
constexpr double share_width_pt = 90;
constexpr double max_head_pt = 80; // wider headings are wrapped
constexpr double share_height_pt = 8;
constexpr double swatch_pt = 7;
constexpr double swatch_gap_pt = 4;
constexpr std::size_t rows_that_stay_together = 12; // longer tables may be split over pages
constexpr std::size_t rows_with_the_head = 2;       // minimum under the first heading

double swatch_width(const Cell& cell) {
    return cell.swatch ? swatch_pt + swatch_gap_pt : 0;
}

/// Column positions of a table, and its font size.
class Columns {
public:
    Columns(const PdfSheets& sheets, const Table& table) : sheets_{sheets}, table_{table} {
        for (const double size_pt : sizes_pt) {
            size_pt_ = size_pt;
            measure();
            if (sum_of(least_) <= room_pt()) {
                break;
            }
        }
        share_out();
    }

    double size_pt() const { return size_pt_; }
    double x_pt(std::size_t column) const {
        return sheets_.left_pt() +
               std::accumulate(
                   widths_.begin(), widths_.begin() + static_cast<std::ptrdiff_t>(column), 0.0) +
               gap_pt * static_cast<double>(column);
    }
    double width_pt(std::size_t column) const { return widths_[column]; }
    double whole_pt() const { return sum_of(widths_) + gap_pt * static_cast<double>(gaps()); }

    PdfType type(std::size_t column, bool bold) const {
        return {.size_pt = size_pt_, .bold = bold, .to_the_right = table_.columns[column].number};
    }
    PdfType head_type(std::size_t column) const {
        auto type = this->type(column, true);
        type.size_pt = size_pt_ - 0.5;
        type.rgb = print::quiet;
        return type;
    }

private:
    static double sum_of(const std::vector<double>& widths) {
        return std::accumulate(widths.begin(), widths.end(), 0.0);
    }
    std::size_t gaps() const { return table_.columns.size() - 1; }
    double room_pt() const { return sheets_.width_pt() - gap_pt * static_cast<double>(gaps()); }

    /// Returns the width of the longest word.
    double least_of(const RichText& text, PdfType type) const {
        type.breaks_words = false;
        return sheets_.text(text, type, 0).width_pt();
    }

    void measure() {
        least_.assign(table_.columns.size(), 0);
        wanted_.assign(table_.columns.size(), 0);
        for (std::size_t c = 0; c < table_.columns.size(); ++c) {
            const auto& title = table_.columns[c].title;
            const double whole = sheets_.text(title, head_type(c), -1).width_pt();
            least_[c] = least_of(title, head_type(c));
            wanted_[c] = std::max(least_[c], std::min(whole, max_head_pt));
            for (const auto& row : table_.rows) {
                measure(row[c], c);
            }
        }
    }

    void measure(const Cell& cell, std::size_t c) {
        if (!cell.shares.empty()) {
            least_[c] = std::max(least_[c], share_width_pt / 2);
            wanted_[c] = std::max(wanted_[c], share_width_pt);
            return;
        }
        const bool bold = table_.sum; // as the last row may be
        const double whole =
            sheets_.text(cell.text, type(c, bold), -1).width_pt() + swatch_width(cell);
        const double word = table_.columns[c].number
                                ? whole
                                : least_of(cell.text, type(c, bold)) + swatch_width(cell);
        wanted_[c] = std::max(wanted_[c], whole);
        // A name may be wider than the page; such a word is broken.
        least_[c] = std::max(least_[c], std::min(word, sheets_.width_pt() / 4));
    }

    /// Distributes the width. If the columns want more than available, the difference is taken from
    /// those that can wrap, in proportion to their slack.
    void share_out() {
        widths_ = wanted_;
        const double missing = sum_of(wanted_) - room_pt();
        const double spare = sum_of(wanted_) - sum_of(least_);
        if (missing <= 0 || spare <= 0) {
            return;
        }
        const double share = std::min(1.0, missing / spare);
        for (std::size_t c = 0; c < widths_.size(); ++c) {
            widths_[c] -= share * (wanted_[c] - least_[c]);
        }
    }

    const PdfSheets& sheets_;
    const Table& table_;
    double size_pt_ = 0;
    std::vector<double> least_, wanted_, widths_;
};

/// Tolerance for letter widths that are rounded elsewhere.
constexpr double play_pt = 0.1;

struct Row {
    std::vector<PdfText> texts;
    double height_pt = 0;
};

Row head_of(const PdfSheets& sheets, const Table& table, const Columns& columns) {
    Row row;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        row.texts.push_back(sheets.text(
            table.columns[c].title, columns.head_type(c), columns.width_pt(c) + play_pt));
        row.height_pt = std::max(row.height_pt, row.texts.back().height_pt() + 2 * padding_pt);
    }
    return row;
}

Row row_of(const PdfSheets& sheets, const Table& table, const Columns& columns, std::size_t i) {
    const bool bold = table.sum && i + 1 == table.rows.size();
    Row row;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const auto& cell = table.rows[i][c];
        row.texts.push_back(sheets.text(cell.shares.empty() ? cell.text : RichText{""},
                                        columns.type(c, bold),
                                        columns.width_pt(c) - swatch_width(cell) + play_pt));
        row.height_pt = std::max(row.height_pt, row.texts.back().height_pt() + 2 * padding_pt);
    }
    return row;
}

std::string words_of(const Cell& cell) {
    std::string words;
    for (const auto& span : cell.text.spans) {
        words += span.text;
    }
    return words;
}

/// Draws the headings of the columns; those that a further page repeats are decoration.
void draw_head(PdfSheets& sheets, const Columns& columns, const Row& head, bool is_first) {
    if (is_first) {
        sheets.begin("TR");
    }
    for (std::size_t c = 0; c < head.texts.size(); ++c) {
        const double lower = head.height_pt - padding_pt - head.texts[c].height_pt();
        if (is_first) {
            sheets.scope_heading("Column");
            sheets.begin("TH");
        }
        sheets.draw(head.texts[c], columns.x_pt(c), sheets.y_pt() + lower);
        if (is_first) {
            sheets.end("TH");
        }
    }
    if (is_first) {
        sheets.end("TR");
    }
    sheets.skip(head.height_pt);
    sheets.rule(print::edge, sheets.left_pt(), sheets.y_pt(), columns.whole_pt());
}

void draw_shares(PdfSheets& sheets, const Cell& cell, double x_pt, double y_pt, double width_pt) {
    const PdfFigure figure{sheets, words_of(cell)};
    double from = 0;
    for (const auto& [percent, rgb] : cell.shares) {
        sheets.fill(
            rgb, x_pt + width_pt * from / 100, y_pt, width_pt * percent / 100, share_height_pt);
        from += percent;
    }
    sheets.frame(print::edge, x_pt, y_pt, width_pt, share_height_pt);
}

/// Draws a cell of a row whose text begins at a height.
void draw_cell(PdfSheets& sheets,
               const Columns& columns,
               std::size_t c,
               const PdfText& text,
               const Cell& cell,
               double y_pt) {
    if (c == 0) {
        sheets.scope_heading("Row");
    }
    const PdfElement element{sheets, c == 0 ? "TH" : "TD"};
    const double x_pt = columns.x_pt(c);
    if (cell.swatch) {
        const double middle = (text.height_pt() - swatch_pt) / 2;
        sheets.fill(*cell.swatch, x_pt, y_pt + middle, swatch_pt, swatch_pt);
        sheets.frame(print::edge, x_pt, y_pt + middle, swatch_pt, swatch_pt);
    }
    if (!cell.shares.empty()) {
        draw_shares(sheets, cell, x_pt, y_pt + 1, columns.width_pt(c));
        return;
    }
    sheets.draw(text, x_pt + swatch_width(cell), y_pt);
}

void draw_row(PdfSheets& sheets,
              const Columns& columns,
              const Row& row,
              const std::vector<Cell>& cells) {
    const double y_pt = sheets.y_pt() + padding_pt;
    {
        const PdfElement element{sheets, "TR"};
        for (std::size_t c = 0; c < cells.size(); ++c) {
            draw_cell(sheets, columns, c, row.texts[c], cells[c], y_pt);
        }
    }
    sheets.skip(row.height_pt);
    sheets.rule(print::border, sheets.left_pt(), sheets.y_pt(), columns.whole_pt());
}

/// Table laid out in rows.
struct TableLayout {
    Columns columns;
    PdfText caption;
    Row head;
    std::vector<Row> rows;

    /// Returns the height of the part that stays with the caption.
    double first_pt() const {
        const auto together = rows.size() <= rows_that_stay_together
                                  ? rows.size()
                                  : std::min(rows.size(), rows_with_the_head);
        double height_pt = caption.height_pt() + padding_pt + head.height_pt;
        for (std::size_t i = 0; i < together; ++i) {
            height_pt += rows[i].height_pt;
        }
        return height_pt;
    }
};

TableLayout lay_out(const PdfSheets& sheets, const Table& table) {
    const Columns columns{sheets, table};
    TableLayout layout{columns,
                       sheets.text(table.caption,
                                   {.size_pt = small_size_pt, .rgb = print::quiet},
                                   sheets.width_pt()),
                       head_of(sheets, table, columns),
                       {}};
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        layout.rows.push_back(row_of(sheets, table, columns, i));
    }
    return layout;
}

} // namespace

double first_pt(const PdfSheets& sheets, const Table& table) {
    return lay_out(sheets, table).first_pt();
}

void put(PdfSheets& sheets, const Table& table) {
    const auto layout = lay_out(sheets, table);
    const auto& [columns, caption, head, rows] = layout;
    sheets.need(std::min(layout.first_pt(), sheets.height_pt()));
    const PdfElement element{sheets, "Table"};
    {
        const PdfElement title{sheets, "Caption"};
        sheets.draw(caption, sheets.left_pt(), sheets.y_pt());
    }
    sheets.skip(caption.height_pt() + padding_pt);
    draw_head(sheets, columns, head, true);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!sheets.has_room(rows[i].height_pt)) {
            sheets.need(rows[i].height_pt);
            draw_head(sheets, columns, head, false);
        }
        draw_row(sheets, columns, rows[i], table.rows[i]);
    }
    sheets.skip(block_gap_pt);
}

} // namespace macadam
