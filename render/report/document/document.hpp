#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace macadam {

/// PNG files of one picture: for light pages and paper, and for dark pages (empty: the same one).
struct ReportPicture {
    std::vector<std::uint8_t> light_png;
    std::vector<std::uint8_t> dark_png;
    int width_px = 0;
    int height_px = 0;
};

namespace document {

// A report as neither HTML nor PDF: what it says, in order, in final words. Texts are UTF-8 as they
// came, not escaped for anything; '\n' breaks a line. report_html and report_pdf write the same
// document.

enum class SpanLook {
    plain,
    strong,
    quiet,
    phone ///< only where a narrow screen leaves out columns that say it
};

/// A run of text in one look.
struct Span {
    std::string text;
    SpanLook look = SpanLook::plain;
    bool unbroken = false; ///< stays on one line
    std::string target{};  ///< id of a place of this document that it leads to; "" = none
};

/// Text with what stands out in it.
struct RichText {
    std::vector<Span> spans;

    RichText() = default;
    RichText(std::string text) : spans{{.text = std::move(text)}} {} // NOLINT(*-explicit-*)
    RichText(const char* text) : RichText{std::string{text}} {}      // NOLINT(*-explicit-*)
    RichText(std::vector<Span> runs) : spans{std::move(runs)} {}     // NOLINT(*-explicit-*)
};

// ------------------------------------------------------------------------------------ drawings

enum class StrokeLook { grid, mean, curve };
enum class Anchor { start, middle, end };

struct Stroke {
    StrokeLook look;
    std::vector<std::pair<double, double>> points;
};
struct Bar {
    double x, y, width, height;
    std::uint32_t rgb;
    bool edged = true; ///< with the page's own edge, so that no colour is lost on it
};
struct Label {
    double x, y; ///< of the anchor, on the base line
    Anchor anchor;
    std::string text;
};
struct Dots {
    std::vector<std::pair<double, double>> places;
    double width;
    std::uint32_t rgb;
};
using Shape = std::variant<Stroke, Bar, Label, Dots>;

/// A figure of lines and letters, y downwards, in units of which about 400 fit a phone. Letters are
/// 12 units high.
struct Drawing {
    double width;
    double height;
    std::string words; ///< the same for those who listen
    std::vector<Shape> shapes;
};

// ------------------------------------------------------------------------------------- blocks

struct Paragraph {
    RichText text;
    bool small = false; ///< a remark
};

struct Bullets {
    std::vector<RichText> items;
};

/// A number that counts, with what it is over it and more of it under it.
struct KeyNumber {
    std::string what;
    std::string value;
    RichText more;
};

struct KeyNumbers {
    std::vector<KeyNumber> numbers;
};

/// Part of a bar, in percent of it.
struct ShareOfBar {
    double percent;
    std::uint32_t rgb;
};

struct Cell {
    RichText text;
    std::optional<std::uint32_t> swatch{}; ///< a little square of this colour before the text
    std::vector<ShareOfBar> shares{};      ///< a bar instead; the text is for those who listen

    Cell(RichText rich) : text{std::move(rich)} {}        // NOLINT(*-explicit-*)
    Cell(std::string plain) : text{std::move(plain)} {}   // NOLINT(*-explicit-*)
    Cell(const char* plain) : text{std::string{plain}} {} // NOLINT(*-explicit-*)
};

struct Column {
    std::string title;
    bool number = false;    ///< aligned to the right
    bool elsewhere = false; ///< left out on phones: the page says it in another place, too
};

/// A table whose first column names its rows; as many cells in a row as columns.
struct Table {
    std::string caption;
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;
    bool sum = false;    ///< the last row is of all others together
    bool stacks = false; ///< where columns have no room each row is a block of titles and values
};

struct LegendEntry {
    std::optional<std::uint32_t> rgb; ///< nothing: the line of a road without a measurement
    std::string name;
    std::string range;
    std::optional<std::uint32_t> dark_rgb{}; ///< on dark pages; nothing: the same
};

struct Legend {
    std::string title;
    std::vector<LegendEntry> entries;
};

/// The map of all roads.
struct MapFigure {
    ReportPicture picture;
    std::string words;    ///< for those who listen
    double scale_percent; ///< length of the scale bar, of the picture's width; 0 = none
    std::string scale;    ///< "1 km, north up"
    std::string caption;
};

/// A small map with what it shows.
struct Card {
    std::string id; ///< links lead there
    ReportPicture picture;
    std::string words; ///< for those who listen
    std::string title;
    RichText text;
};

struct Cards {
    std::vector<Card> cards;
};

using Block =
    std::variant<Paragraph, Bullets, KeyNumbers, Table, Drawing, Legend, MapFigure, Cards>;

struct DocumentSection {
    std::string title;
    std::vector<Block> blocks;
};

struct Document {
    std::string language; ///< "en"
    std::string title;
    RichText subtitle;
    std::string running_head; ///< on every page of paper but the first
    std::string page_of;      ///< "Page {page} of {pages}"
    std::string day;          ///< the newest of the data, "2026-04-02"; "" = none
    KeyNumbers keys;
    std::vector<DocumentSection> sections;
    std::vector<DocumentSection> end; ///< whose data, after all else
};

} // namespace document

using document::Document;

} // namespace macadam
