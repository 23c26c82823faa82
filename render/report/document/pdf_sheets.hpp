#pragma once

#include "render/report/document/document.hpp"
#include "render/report/document/pdf.hpp"
#include "render/report/document/pdf_text.hpp"

#include <cairo-pdf.h>

#include <memory>
#include <optional>
#include <string>

namespace macadam {

using CairoSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using CairoContext = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

/// Sheets of paper that are filled from above. Points of 1/72 inch, from the upper left corner.
class PdfSheets {
public:
    /// \param pages  how many there will be; nothing: they are only counted, and pictures left out
    PdfSheets(const Document& document, const PdfConfig& config, std::optional<int> pages);

    double left_pt() const { return side_margin_pt; }
    double width_pt() const { return paper_.width_pt - 2 * side_margin_pt; }
    double height_pt() const { return bottom_pt() - top_margin_pt; } ///< of a page's content
    double y_pt() const { return y_pt_; }
    bool is_counting() const { return !pages_; }
    cairo_t* cairo() const { return cairo_.get(); }

    /// Goes to a new page if there is less room; nothing is ever as high as that of a whole page
    /// but what fills it.
    void need(double height_pt);
    void skip(double height_pt);
    bool is_at_top() const { return y_pt_ <= top_margin_pt; }
    bool has_room(double height_pt) const { return y_pt_ + height_pt <= bottom_pt(); }

    PdfText text(const document::RichText& rich, const PdfType& type, double width_pt) const;

    /// Draws it with its upper left corner there.
    void draw(const PdfText& text, double x_pt, double y_pt) const;
    void fill(std::uint32_t rgb, double x_pt, double y_pt, double width_pt, double height_pt) const;
    void
    frame(std::uint32_t rgb, double x_pt, double y_pt, double width_pt, double height_pt) const;
    void rule(std::uint32_t rgb, double x_pt, double y_pt, double width_pt) const;
    void picture(const ReportPicture& picture, double x_pt, double y_pt, double width_pt) const;

    /// A place that links lead to, there.
    void place(const std::string& id, double y_pt) const;

    /// An entry of the outline, at the height that was reached. \returns what entries below it ask
    /// for. \param above  0: none.
    int outline(const std::string& title, int above) const;

    /// Likewise, at a place.
    int outline_to(const std::string& id, const std::string& title, int above) const;

    int count() const { return page_; }

    /// The bytes of the file; nothing may be drawn after it.
    std::string finished();

private:
    static constexpr double side_margin_pt = 42.52;   // 15 mm
    static constexpr double top_margin_pt = 51.02;    // 18 mm
    static constexpr double bottom_margin_pt = 51.02; // 18 mm

    double bottom_pt() const { return paper_.height_pt - bottom_margin_pt; }
    void draw_map_surround() const;
    void begin_page();

    const Document& document_;
    Paper paper_;
    std::optional<int> pages_;
    std::string bytes_;
    CairoSurface surface_;
    CairoContext cairo_;
    double y_pt_ = top_margin_pt;
    int page_ = 0;
};

} // namespace macadam
