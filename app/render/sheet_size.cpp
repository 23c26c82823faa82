#include "app/render/sheet_size.hpp"

#include "app/render/picture_output.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr double pdf_px_per_inch = 150; // the page's own unit; its lines and letters are vectors
constexpr double screen_dpi = 96;       // CSS's pixel
constexpr double paper_dpi = 300;
constexpr double min_dpi = 24;
constexpr double max_dpi = 1200;
constexpr double mm_per_inch = 25.4;
constexpr double min_denominator = 100;
constexpr double max_denominator = 1e8;

// ISO 216 and ANSI/ASME Y14.1.
struct Paper {
    std::string_view name;
    double width_mm, height_mm;
};
constexpr std::array papers{Paper{"A0", 841, 1189},
                            Paper{"A1", 594, 841},
                            Paper{"A2", 420, 594},
                            Paper{"A3", 297, 420},
                            Paper{"A4", 210, 297},
                            Paper{"A5", 148, 210},
                            Paper{"letter", 215.9, 279.4},
                            Paper{"legal", 215.9, 355.6},
                            Paper{"tabloid", 279.4, 431.8}};

struct SizeMm {
    double width, height;
};

struct SizePx {
    int width, height;
};

/// Parses "WxH"; `std::nullopt` if the text is anything else.
template <typename Number>
std::optional<std::pair<Number, Number>> two_numbers(std::string_view text) {
    Number width{};
    Number height{};
    const auto* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    if (first.ec != std::errc{} || first.ptr == end || *first.ptr != 'x') {
        return {};
    }
    const auto second = std::from_chars(first.ptr + 1, end, height);
    if (second.ec != std::errc{} || second.ptr != end) {
        return {};
    }
    return std::pair{width, height};
}

std::optional<SizeMm> paper_size(const std::string& name, bool landscape) {
    const auto* const paper = std::ranges::find_if(
        papers, [&](const Paper& each) { return in_lower_case(each.name) == in_lower_case(name); });
    if (paper == papers.end()) {
        return {};
    }
    return landscape ? SizeMm{paper->height_mm, paper->width_mm}
                     : SizeMm{paper->width_mm, paper->height_mm};
}

/// Parses a size on paper: millimetres or the name of a paper.
std::optional<SizeMm> size_on_paper(const std::string& text, bool landscape) {
    if (text.ends_with("mm")) {
        const auto size = two_numbers<double>(std::string_view{text}.substr(0, text.size() - 2));
        return size ? std::optional<SizeMm>{{size->first, size->second}} : std::nullopt;
    }
    return paper_size(text, landscape);
}

SizePx in_px(const SizeMm& size, double px_per_inch) {
    // A side beyond any limit stays beyond it, and an int holds it.
    const auto px = [&](double mm) {
        return int(std::lround(std::clamp(mm / mm_per_inch * px_per_inch, -1.0, 1e6)));
    };
    return {px(size.width), px(size.height)};
}

void expect_px_in_range(const std::string& text, const SizePx& size, bool on_paper, double dpi) {
    const auto fits = [](int px) { return px >= min_image_px && px <= max_image_px; };
    if (!fits(size.width) || !fits(size.height)) {
        throw UsageError{
            on_paper ? fmt::format("--size is '{}', which is {} x {} pixels at {:g} dpi, expected "
                                   "both from {} to {} pixels",
                                   text,
                                   size.width,
                                   size.height,
                                   dpi,
                                   min_image_px,
                                   max_image_px)
                     : fmt::format("--size is '{}', expected WxH with both from {} to {} pixels",
                                   text,
                                   min_image_px,
                                   max_image_px)};
    }
}

PictureSize sheet(const SizePx& px, double px_per_inch, bool is_on_paper) {
    return {.width_px = px.width,
            .height_px = px.height,
            .px_per_inch = px_per_inch,
            .is_on_paper = is_on_paper};
}

std::optional<double> parse_dpi(const Arguments& arguments) {
    const auto dpi = arguments.number("--dpi");
    if (dpi && !(min_dpi <= *dpi && *dpi <= max_dpi)) {
        throw UsageError{
            fmt::format("--dpi is '{:g}', expected {:g} to {:g}", *dpi, min_dpi, max_dpi)};
    }
    return dpi;
}

} // namespace

PictureSize picture_size(const Arguments& arguments) {
    const auto text = arguments.value("--size").value_or(std::string{default_picture_size});
    const auto dpi = parse_dpi(arguments);
    if (const auto mm = size_on_paper(text, arguments.flag("--landscape"))) {
        const double px_per_inch = dpi.value_or(paper_dpi);
        const auto px = in_px(*mm, px_per_inch);
        expect_px_in_range(text, px, true, px_per_inch);
        return sheet(px, px_per_inch, true);
    }
    const auto px = two_numbers<int>(text);
    if (!px) {
        throw UsageError{fmt::format("--size is '{}', expected pixels such as 1600x1200, "
                                     "millimetres such as 420x594mm, or a paper size such as A2",
                                     text)};
    }
    expect_px_in_range(text, {px->first, px->second}, false, 0);
    return sheet({px->first, px->second}, dpi.value_or(screen_dpi), false);
}

PictureSize pdf_size(const Arguments& arguments) {
    const auto paper = arguments.value("--paper").value_or(std::string{default_paper});
    const auto text = arguments.value("--size").value_or(paper);
    const auto mm = size_on_paper(text, arguments.flag("--landscape"));
    if (!mm) {
        throw UsageError{fmt::format("--size is '{}', expected for a .pdf millimetres such as "
                                     "420x594mm, or --paper",
                                     text)};
    }
    const auto px = in_px(*mm, pdf_px_per_inch);
    expect_px_in_range(text, px, true, pdf_px_per_inch);
    return sheet(px, pdf_px_per_inch, true);
}

std::optional<double> parse_scale(const Arguments& arguments) {
    const auto text = arguments.value("--scale");
    if (!text) {
        return {};
    }
    std::string_view digits = *text;
    if (digits.starts_with("1:")) {
        digits.remove_prefix(2);
    }
    double denominator = 0;
    const auto* const end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, denominator);
    if (read.ec != std::errc{} || read.ptr != end ||
        !(min_denominator <= denominator && denominator <= max_denominator)) {
        throw UsageError{fmt::format(
            "--scale is '{}', expected 100 to 100000000, such as 25000 or 1:25000", *text)};
    }
    return denominator;
}

bool is_paper(const std::string& text) {
    return paper_size(text, false).has_value();
}

} // namespace macadam
