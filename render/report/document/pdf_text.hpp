#pragma once

#include "render/report/document/document.hpp"

#include <pango/pangocairo.h>

#include <cstdint>
#include <memory>
#include <string>

namespace macadam {

/// Colours of print, as in MapStyle::Theme::print.
namespace print {
inline constexpr std::uint32_t ink = 0x1a1a1a;
inline constexpr std::uint32_t quiet = 0x555555;
inline constexpr std::uint32_t border = 0xc8c8c8;
inline constexpr std::uint32_t edge = 0x404040;
} // namespace print

/// Typographic style of text.
struct PdfType {
    double size_pt;
    bool bold = false;
    std::uint32_t rgb = print::ink;
    bool to_the_right = false;
    bool breaks_words = true; ///< if they are longer than a line
};

/// Text laid out in lines.
class PdfText {
public:
    /// \param width_pt  line width; less than 0: lines end only at line breaks
    PdfText(cairo_t* cairo, const document::RichText& rich, const PdfType& type, double width_pt);

    double width_pt() const;   ///< of its widest line
    double height_pt() const;  ///< of all lines
    bool is_reordered() const; ///< some of its letters run from right to left
    std::string in_order_of_reading() const;
    PangoLayout* layout() const { return layout_.get(); }
    std::uint32_t rgb() const { return rgb_; }
    const std::string& target() const { return target_; }   ///< "" = no link within the document
    const std::string& address() const { return address_; } ///< "" = no link to elsewhere

private:
    struct Free {
        void operator()(PangoLayout* layout) const { g_object_unref(layout); }
    };
    std::unique_ptr<PangoLayout, Free> layout_;
    std::uint32_t rgb_;
    std::string target_, address_;
};

} // namespace macadam
