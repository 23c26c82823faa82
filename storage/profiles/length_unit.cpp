
#include "storage/profiles/length_unit.hpp"

#include "storage/text/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace macadam {

namespace {

constexpr std::size_t longest_word = 8; // the width of a unit in an ERD file

struct LengthUnit {
    std::string_view word;
    double metres;
};

constexpr double inch_m = 0.0254; // exactly, international yard and pound agreement of 1959
constexpr double foot_m = 12 * inch_m;
constexpr double mil_m = inch_m / 1000;

constexpr std::array units{
    LengthUnit{"m", 1},           LengthUnit{"meter", 1},     LengthUnit{"meters", 1},
    LengthUnit{"metre", 1},       LengthUnit{"metres", 1},    LengthUnit{"cm", 1e-2},
    LengthUnit{"centimet", 1e-2}, LengthUnit{"mm", 1e-3},     LengthUnit{"millimet", 1e-3},
    LengthUnit{"um", 1e-6},       LengthUnit{"micron", 1e-6}, LengthUnit{"microns", 1e-6},
    LengthUnit{"micromet", 1e-6}, LengthUnit{"ft", foot_m},   LengthUnit{"foot", foot_m},
    LengthUnit{"feet", foot_m},   LengthUnit{"in", inch_m},   LengthUnit{"inch", inch_m},
    LengthUnit{"inches", inch_m}, LengthUnit{"mil", mil_m},   LengthUnit{"mils", mil_m}};

} // namespace

std::optional<double> metres_in(std::string_view unit) {
    unit = trimmed(unit);
    if (unit.ends_with('.')) {
        unit.remove_suffix(1);
    }
    std::string word{unit.substr(0, longest_word)};
    std::ranges::transform(
        word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* const found = std::ranges::find(units, word, &LengthUnit::word);
    return found == units.end() ? std::nullopt : std::optional{found->metres};
}

} // namespace macadam
