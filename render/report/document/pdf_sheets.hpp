#pragma once

#include "render/report/document/document.hpp"
#include "render/report/document/pdf.hpp"
#include "render/report/document/pdf_tags.hpp"
#include "render/report/document/pdf_text.hpp"

#include <cairo-pdf.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

using CairoSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using CairoContext = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

/// Sheets of paper that are filled from the top. Points of 1/72 inch, from the upper left corner.
class PdfSheets {
public:
    /// \param pages  number of pages; `std::nullopt`: pages are only counted, and pictures are
    ///               omitted
    PdfSheets(const Document& document, const PdfConfig& config, std::optional<int> pages);

    double left_pt() const { return side_margin_pt; }
    double width_pt() const { return paper_.width_pt - 2 * side_margin_pt; }
    double height_pt() const { return bottom_pt() - top_margin_pt; } ///< of a page's content
    double y_pt() const { return y_pt_; }
    bool is_counting() const { return !pages_; }
    cairo_t* cairo() const { return cairo_.get(); }

    /// Starts a new page if less height is left. The height must not exceed that of a page, except
    /// for content that fills it.
    void need(double height_pt);
    void skip(double height_pt);
    bool is_at_top() const { return y_pt_ <= top_margin_pt; }
    double room_pt() const { return bottom_pt() - y_pt_; } ///< left on the page
    bool has_room(double height_pt) const { return y_pt_ + height_pt <= bottom_pt(); }

    PdfText text(const document::RichText& rich, const PdfType& type, double width_pt) const;

    /// Draws text with its upper left corner at a position.
    void draw(const PdfText& text, double x_pt, double y_pt);
    void fill(std::uint32_t rgb, double x_pt, double y_pt, double width_pt, double height_pt) const;
    void
    frame(std::uint32_t rgb, double x_pt, double y_pt, double width_pt, double height_pt) const;
    void rule(std::uint32_t rgb, double x_pt, double y_pt, double width_pt) const;
    void picture(const ReportPicture& picture, double x_pt, double y_pt, double width_pt) const;
    void photo(const document::Photo& photo, double x_pt, double y_pt, double width_pt) const;

    /// Sets a link target at a height.
    void place(const std::string& id, double y_pt) const;

    /// Adds an outline entry at the current height. \returns its id, the parent of entries below
    /// it. \param above  parent; 0: none.
    int outline(const std::string& title, int above) const;

    /// Adds an outline entry for a link target.
    int outline_to(const std::string& id, const std::string& title, int above) const;

    /// Begins and ends an element of the structure that assistive software reads: "P", "H1",
    /// "Table". What is drawn outside of elements without children is decoration.
    void begin(const char* tag, const std::string& attributes = {});
    void end(const char* tag);

    /// Records the text alternative of the figure, or the scope of the heading of a table, that
    /// begins next.
    void describe_figure(const std::string& words) { access_.figures.push_back(words); }
    void scope_heading(const char* scope) { access_.heading_scope.emplace_back(scope); }

    int count() const { return page_; }

    /// Returns the bytes of the file; no drawing is allowed afterwards.
    std::string finished();

private:
    /// Element of the structure that has begun.
    struct OpenElement {
        std::size_t number;
        bool is_read; ///< what is drawn in it: no decoration, and no figure
        std::string text{};
        bool is_reordered = false; ///< letters of the text run from right to left
    };

    static constexpr double side_margin_pt = 42.52;   // 15 mm
    static constexpr double top_margin_pt = 51.02;    // 18 mm
    static constexpr double bottom_margin_pt = 51.02; // 18 mm

    double bottom_pt() const { return paper_.height_pt - bottom_margin_pt; }
    void draw_map_surround();
    void record(const PdfText& text);
    void begin_page();
    void paint(cairo_surface_t& image, double x_pt, double y_pt, double scale) const;

    const Document& document_;
    Paper paper_;
    std::optional<int> pages_;
    std::string bytes_;
    CairoSurface surface_;
    CairoContext cairo_;
    double y_pt_ = top_margin_pt;
    int page_ = 0;
    PdfAccess access_;
    std::vector<OpenElement> open_;
};

/// Element of the structure during the lifetime of this value.
class PdfElement {
public:
    PdfElement(PdfSheets& sheets, const char* tag) : sheets_{sheets}, tag_{tag} {
        sheets_.begin(tag_);
    }
    PdfElement(const PdfElement&) = delete;
    PdfElement& operator=(const PdfElement&) = delete;
    ~PdfElement() { sheets_.end(tag_); }

private:
    PdfSheets& sheets_;
    const char* tag_;
};

/// Figure with its text alternative.
class PdfFigure {
public:
    PdfFigure(PdfSheets& sheets, const std::string& words)
        : element_{(sheets.describe_figure(words), sheets), "Figure"} {}

private:
    PdfElement element_;
};

} // namespace macadam
