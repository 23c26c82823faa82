#include "render/report/parts.hpp"

#include "estimator/common/utf8.hpp"
#include "render/report/html.hpp"
#include "render/report/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {

std::string sentence_case(std::string_view name) {
    auto text = escaped(name);
    std::ranges::replace(text, '_', ' ');
    if (!text.empty() && 'a' <= text[0] && text[0] <= 'z') {
        text[0] = static_cast<char>(text[0] - 'a' + 'A');
    }
    return text;
}

std::string count_text(std::size_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count_text(count), count == 1 ? one : many);
}

std::string unbroken(const std::string& html) {
    return "<span class=\"nw\">" + html + "</span>";
}

std::string breakable(std::string_view text) {
    constexpr std::size_t longest_word = 24; // letters
    std::string html;
    std::string piece;
    std::size_t letters = 0;
    while (!text.empty()) {
        const auto length = std::max<std::size_t>(1, utf8_length(text));
        letters = text.front() == ' ' ? 0 : letters + 1;
        if (letters > longest_word) {
            html += escaped(piece) + "<wbr>";
            piece.clear();
            letters = 1;
        }
        piece += text.substr(0, length);
        text.remove_prefix(length);
    }
    return html + escaped(piece);
}

std::string picture_html(const ReportPicture& picture, const std::string& alt) {
    const auto image = [&](const char* look, const std::vector<std::uint8_t>& png) {
        return fmt::format("<img class=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" "
                           "src=\"data:image/png;base64,{}\">",
                           look,
                           picture.width_px,
                           picture.height_px,
                           alt,
                           base64(png));
    };
    return image("light", picture.light_png) + image("dark", picture.dark_png);
}

std::size_t cars_in(const std::vector<ReportVehicle>& vehicles) {
    std::vector<std::string> names;
    for (const auto& vehicle : vehicles) {
        names.push_back(vehicle.name);
    }
    std::ranges::sort(names);
    return static_cast<std::size_t>(std::ranges::unique(names).begin() - names.begin());
}

ReportVehicle total_of(const std::vector<ReportVehicle>& vehicles) {
    ReportVehicle total;
    for (const auto& vehicle : vehicles) {
        total.trips += vehicle.trips;
        total.undated_trips += vehicle.undated_trips;
        total.passes += vehicle.passes;
        total.km += vehicle.km;
        total.matched_km += vehicle.matched_km;
        total.rows_read += vehicle.rows_read;
        total.rows_used += vehicle.rows_used;
    }
    return total;
}

} // namespace macadam
