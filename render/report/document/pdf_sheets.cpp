#include "render/report/document/pdf_sheets.hpp"

#include "estimator/common/error.hpp"
#include "render/scene/isolated_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

namespace macadam {
namespace {

constexpr double head_size_pt = 7.5;
constexpr double head_y_pt = 25;
constexpr double hairline_pt = 0.5;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data),
                                             length); // NOLINT(*-reinterpret-cast)
    return CAIRO_STATUS_SUCCESS;
}

cairo_status_t take(void* rest, unsigned char* data, unsigned int length) {
    auto& bytes = *static_cast<std::span<const std::uint8_t>*>(rest);
    if (bytes.size() < length) {
        return CAIRO_STATUS_READ_ERROR;
    }
    std::memcpy(data, bytes.data(), length);
    bytes = bytes.subspan(length);
    return CAIRO_STATUS_SUCCESS;
}

void set_colour(cairo_t* cairo, std::uint32_t rgb) {
    const auto part = [rgb](unsigned shift) { return (rgb >> shift & 0xFFU) / 255.0; };
    cairo_set_source_rgb(cairo, part(16), part(8), part(0));
}

/// Quotes a name for the attributes of Cairo's tags.
std::string quoted(const std::string& id) {
    std::string text = "'";
    for (const char c : id) {
        text += c == '\'' || c == '\\' ? std::string{'\\', c} : std::string{c};
    }
    return text + "'";
}

std::string with_numbers(std::string text, int page, int pages) {
    for (const auto& [place, number] : {std::pair{"{page}", page}, std::pair{"{pages}", pages}}) {
        if (const auto at = text.find(place); at != std::string::npos) {
            text.replace(at, std::strlen(place), std::to_string(number));
        }
    }
    return text;
}

} // namespace

PdfSheets::PdfSheets(const Document& document, const PdfConfig& config, std::optional<int> pages)
    : document_{document}, paper_{config.paper}, pages_{pages},
      surface_{
          cairo_pdf_surface_create_for_stream(append, &bytes_, paper_.width_pt, paper_.height_pt),
          cairo_surface_destroy},
      cairo_{cairo_create(surface_.get()), cairo_destroy} {
    const auto set = [&](cairo_pdf_metadata_t what, const std::string& text) {
        cairo_pdf_surface_set_metadata(surface_.get(), what, text.c_str());
    };
    set(CAIRO_PDF_METADATA_TITLE, document.title);
    access_.language = document.language;
    access_.title = document.title;
    set(CAIRO_PDF_METADATA_CREATOR, "Macadam");
    set(CAIRO_PDF_METADATA_CREATE_DATE, document.day.empty() ? "" : document.day + "T00:00:00Z");
    begin_page();
}

void PdfSheets::begin_page() {
    ++page_;
    y_pt_ = top_margin_pt;
    draw_map_surround();
}

void PdfSheets::draw_map_surround() {
    const PdfType quiet{.size_pt = head_size_pt, .rgb = print::quiet};
    auto right = quiet;
    right.to_the_right = true;
    draw(text(with_numbers(document_.page_of, page_, pages_.value_or(page_)), right, width_pt()),
         left_pt(),
         paper_.height_pt - bottom_margin_pt + 14);
    if (page_ > 1) {
        const auto head = text(document_.running_head, quiet, width_pt());
        pango_layout_set_height(head.layout(), 0); // one line, with an ellipsis if it is longer
        pango_layout_set_ellipsize(head.layout(), PANGO_ELLIPSIZE_END);
        draw(head, left_pt(), head_y_pt);
        rule(print::border, left_pt(), head_y_pt + 14, width_pt());
    }
}

void PdfSheets::need(double height_pt) {
    if (!has_room(height_pt) && !is_at_top()) {
        cairo_show_page(cairo_.get());
        begin_page();
    }
}

void PdfSheets::skip(double height_pt) {
    y_pt_ += height_pt;
}

PdfText
PdfSheets::text(const document::RichText& rich, const PdfType& type, double width_pt) const {
    return {cairo_.get(), rich, type, width_pt};
}

void PdfSheets::draw(const PdfText& text, double x_pt, double y_pt) {
    const bool is_link = !text.target().empty() || !text.address().empty();
    set_colour(cairo_.get(), text.rgb());
    cairo_move_to(cairo_.get(), x_pt, y_pt);
    if (is_link) {
        begin(CAIRO_TAG_LINK,
              text.target().empty() ? "uri=" + quoted(text.address())
                                    : "dest=" + quoted(text.target()));
    }
    record(text);
    pango_cairo_show_layout(cairo_.get(), text.layout());
    cairo_new_path(cairo_.get()); // avoids a line from the text's origin
    if (is_link) {
        end(CAIRO_TAG_LINK);
    }
}

void PdfSheets::begin(const char* tag, const std::string& attributes) {
    if (!open_.empty()) {
        open_.back().is_read = false; // but its children
    }
    open_.push_back({.number = access_.elements++, .is_read = tag != std::string_view{"Figure"}});
    cairo_tag_begin(cairo_.get(), tag, attributes.c_str());
}

void PdfSheets::end(const char* tag) {
    cairo_tag_end(cairo_.get(), tag);
    const auto& element = open_.back();
    if (element.is_reordered && element.is_read) {
        access_.spoken[element.number] = element.text;
    }
    open_.pop_back();
}

/// Adds a text to what the element that it is drawn in says.
void PdfSheets::record(const PdfText& text) {
    if (!open_.empty()) {
        auto& element = open_.back();
        element.text += (element.text.empty() ? "" : " ") + text.in_order_of_reading();
        element.is_reordered = element.is_reordered || text.is_reordered();
    }
}

void PdfSheets::fill(
    std::uint32_t rgb, double x_pt, double y_pt, double width_pt, double height_pt) const {
    set_colour(cairo_.get(), rgb);
    cairo_rectangle(cairo_.get(), x_pt, y_pt, width_pt, height_pt);
    cairo_fill(cairo_.get());
}

void PdfSheets::frame(
    std::uint32_t rgb, double x_pt, double y_pt, double width_pt, double height_pt) const {
    set_colour(cairo_.get(), rgb);
    cairo_set_line_width(cairo_.get(), hairline_pt);
    cairo_rectangle(cairo_.get(), x_pt, y_pt, width_pt, height_pt);
    cairo_stroke(cairo_.get());
}

void PdfSheets::rule(std::uint32_t rgb, double x_pt, double y_pt, double width_pt) const {
    set_colour(cairo_.get(), rgb);
    cairo_set_line_width(cairo_.get(), hairline_pt);
    cairo_move_to(cairo_.get(), x_pt, y_pt);
    cairo_rel_line_to(cairo_.get(), width_pt, 0);
    cairo_stroke(cairo_.get());
}

void PdfSheets::picture(const ReportPicture& picture,
                        double x_pt,
                        double y_pt,
                        double width_pt) const {
    const double scale = width_pt / std::max(1, picture.width_px);
    if (!is_counting()) {
        std::span<const std::uint8_t> bytes{picture.light_png};
        const CairoSurface image{cairo_image_surface_create_from_png_stream(take, &bytes),
                                 cairo_surface_destroy};
        if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) {
            throw InputError{
                fmt::format("cannot read a picture of the report: {}",
                            cairo_status_to_string(cairo_surface_status(image.get())))};
        }
        paint(*image, x_pt, y_pt, scale);
    }
    frame(print::border, x_pt, y_pt, width_pt, scale * picture.height_px);
}

void PdfSheets::photo(const document::Photo& photo,
                      double x_pt,
                      double y_pt,
                      double width_pt) const {
    const double scale = width_pt / std::max(1, photo.width_px);
    if (!is_counting()) { // the file takes the bytes of the JPEG as they are, and no pixels
        const CairoSurface image{
            cairo_image_surface_create(CAIRO_FORMAT_RGB24, photo.width_px, photo.height_px),
            cairo_surface_destroy};
        const auto status = cairo_surface_set_mime_data(image.get(),
                                                        CAIRO_MIME_TYPE_JPEG,
                                                        photo.jpeg.data(),
                                                        photo.jpeg.size(),
                                                        nullptr, // the document outlives the file
                                                        nullptr);
        if (status != CAIRO_STATUS_SUCCESS) {
            throw InputError{
                fmt::format("cannot place a photo: {}", cairo_status_to_string(status))};
        }
        paint(*image, x_pt, y_pt, scale);
    }
    frame(print::border, x_pt, y_pt, width_pt, scale * photo.height_px);
}

void PdfSheets::paint(cairo_surface_t& image, double x_pt, double y_pt, double scale) const {
    cairo_save(cairo_.get());
    cairo_translate(cairo_.get(), x_pt, y_pt);
    cairo_scale(cairo_.get(), scale, scale);
    cairo_set_source_surface(cairo_.get(), &image, 0, 0);
    cairo_paint(cairo_.get());
    cairo_restore(cairo_.get());
}

void PdfSheets::place(const std::string& id, double y_pt) const {
    cairo_save(cairo_.get());
    cairo_tag_begin(cairo_.get(),
                    CAIRO_TAG_DEST,
                    fmt::format("name={} x={:.1f} y={:.1f}", quoted(id), left_pt(), y_pt).c_str());
    cairo_tag_end(cairo_.get(), CAIRO_TAG_DEST);
    cairo_restore(cairo_.get());
}

int PdfSheets::outline(const std::string& title, int above) const {
    return cairo_pdf_surface_add_outline(
        surface_.get(),
        above,
        without_direction_controls(title).c_str(),
        fmt::format("page={} pos=[{:.1f} {:.1f}]", page_, left_pt(), y_pt_).c_str(),
        above == CAIRO_PDF_OUTLINE_ROOT ? CAIRO_PDF_OUTLINE_FLAG_OPEN
                                        : cairo_pdf_outline_flags_t{});
}

int PdfSheets::outline_to(const std::string& id, const std::string& title, int above) const {
    return cairo_pdf_surface_add_outline(surface_.get(),
                                         above,
                                         without_direction_controls(title).c_str(),
                                         ("dest=" + quoted(id)).c_str(),
                                         cairo_pdf_outline_flags_t{});
}

std::string PdfSheets::finished() {
    cairo_show_page(cairo_.get());
    const auto drawn = cairo_status(cairo_.get());
    cairo_surface_finish(surface_.get());
    const auto written = cairo_surface_status(surface_.get());
    for (const auto status : {drawn, written}) {
        if (status != CAIRO_STATUS_SUCCESS) {
            throw InputError{
                fmt::format("cannot write the PDF: {}", cairo_status_to_string(status))};
        }
    }
    return accessible_pdf(bytes_, access_);
}

} // namespace macadam
