#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace macadam {

/// PNG files of one picture: for light pages and paper, and for dark pages (empty: the same
/// picture).
struct ReportPicture {
    std::vector<std::uint8_t> light_png;
    std::vector<std::uint8_t> dark_png;
    int width_px = 0;
    int height_px = 0;
};

namespace document {

// Content of a report, independent of HTML and PDF: ordered blocks with final wording. Texts are
// raw UTF-8, not escaped; '\n' breaks a line. report_html and report_pdf write the same document.

enum class SpanLook {
    plain,
    strong,
    quiet,
    phone ///< only on narrow screens that omit the columns with this content
};

/// Run of text in one look.
struct Span {
    std::string text;
    SpanLook look = SpanLook::plain;
    bool unbroken = false; ///< stays on one line
    std::string target{};  ///< id of the linked position in this document; "" = none
    std::string address{}; ///< of a page elsewhere, for readers who follow it; "" = none
};

/// Text with highlighted runs.
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
    bool edged = true;   ///< outlined in the page's colour, for contrast
    std::string words{}; ///< shown under the pointer on screens; "" = nothing
};
/// Interval of values, drawn translucent in the colour of the text.
struct Band {
    double x, y, width, height;
    std::string words{}; ///< as of Bar
};
struct Label {
    double x, y; ///< of the anchor, on the baseline
    Anchor anchor;
    std::string text;
};
struct Dots {
    std::vector<std::pair<double, double>> places;
    double width;
    std::uint32_t rgb;
};
using Shape = std::variant<Stroke, Bar, Band, Label, Dots>;

/// Figure of lines and letters, y downwards, in units of which about 400 fit a phone. Letters are
/// 12 units high.
struct Drawing {
    double width;
    double height;
    std::string words; ///< text alternative for screen readers
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

/// Key number, with its caption above and details below.
struct KeyNumber {
    std::string what;
    std::string value;
    RichText more;
};

struct KeyNumbers {
    std::vector<KeyNumber> numbers;
};

/// Share of a bar, in percent.
struct ShareOfBar {
    double percent;
    std::uint32_t rgb;
};

struct Cell {
    RichText text;
    std::optional<std::uint32_t> swatch{}; ///< small square of this colour before the text
    std::vector<ShareOfBar> shares{};      ///< bar; the text is for screen readers

    Cell(RichText rich) : text{std::move(rich)} {}        // NOLINT(*-explicit-*)
    Cell(std::string plain) : text{std::move(plain)} {}   // NOLINT(*-explicit-*)
    Cell(const char* plain) : text{std::string{plain}} {} // NOLINT(*-explicit-*)
};

struct Column {
    std::string title;
    bool number = false;    ///< right-aligned
    bool elsewhere = false; ///< omitted on phones: the page contains it elsewhere
};

/// Table whose first column names its rows; every row has as many cells as there are columns.
struct Table {
    std::string caption;
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;
    bool sum = false;    ///< the last row is the total
    bool stacks = false; ///< on narrow screens each row becomes a block of titles and values
};

struct LegendEntry {
    std::optional<std::uint32_t> rgb; ///< `std::nullopt`: the line of a road without a measurement
    std::string name;
    std::string range;
    std::optional<std::uint32_t> dark_rgb{}; ///< on dark pages; `std::nullopt`: the same
};

struct Legend {
    std::string title;
    std::vector<LegendEntry> entries;
};

/// Map of all roads.
struct MapFigure {
    ReportPicture picture;
    std::string words;    ///< text alternative for screen readers
    double scale_percent; ///< length of the scale bar relative to the picture's width; 0 = none
    std::string scale;    ///< "1 km, north up"
    std::string caption;
};

/// Photo with a caption.
struct Photo {
    std::vector<std::uint8_t> jpeg; ///< bytes of a file
    int width_px, height_px;
    std::string words; ///< text alternative for screen readers
    std::string caption;
};

/// Photos side by side.
struct Photos {
    std::vector<Photo> photos;
};

/// Small map with a description.
struct Card {
    std::string id; ///< target of links
    ReportPicture picture;
    std::string words; ///< text alternative for screen readers
    std::string title;
    RichText text;
    std::optional<Drawing> chart{}; ///< under the picture
    std::vector<Photo> photos{};    ///< under the text
};

struct Cards {
    std::vector<Card> cards;
};

using Block =
    std::variant<Paragraph, Bullets, KeyNumbers, Table, Drawing, Legend, MapFigure, Photos, Cards>;

struct DocumentSection {
    std::string title;
    std::vector<Block> blocks;
};

/// The picture of the whole: a map and a distribution, side by side where a screen has room, one
/// below the other on paper.
struct Overview {
    Legend legend;
    MapFigure map;
    std::optional<Drawing> distribution{};      ///< for a column
    std::optional<Drawing> wide_distribution{}; ///< the same over the width of a page
};

/// Words of what a page on screen offers beside its content.
struct PageWords {
    std::string contents;     ///< of the list of sections
    std::string download_csv; ///< button at a table
    std::string sort_by;      ///< "Sort by {column}", of a column's heading
    std::string decimal_mark; ///< of the numbers in tables
};

struct Document {
    std::string language; ///< "en"
    std::string title;
    RichText subtitle;
    std::string running_head; ///< on every printed page but the first
    std::string page_of;      ///< "Page {page} of {pages}"
    std::string day;          ///< date of the newest data, "2026-04-02"; "" = none
    KeyNumbers keys;
    std::vector<DocumentSection> sections;
    std::vector<DocumentSection> end; ///< data sources, at the end
    RichText lead{};                  ///< sentence that says what matters; empty: none
    std::optional<Overview> overview{};
    PageWords words{}; ///< no contents: a page of few sections without a list of them
};

} // namespace document

using document::Document;

} // namespace macadam
