#include "storage/trips/mappings/mapping_keys.hpp"

namespace macadam {

TripColumn
known_channel(const TomlTable& channels, const std::string& name, std::string_view expected_key) {
    const auto channel = channel_named(name);
    if (!channel || *channel == TripColumn::t_s) {
        channels.refuse_unknown(name, "a column of docs/reference/trip-logs.md");
    }
    if (channels.is_text(name)) {
        channels.refuse(name, fmt::format("{{{} = \"{}\"}}", expected_key, channels.text(name)));
    }
    return *channel;
}

std::array<int, 3> axes_of(const TomlTable& table) {
    constexpr std::string_view expected = "x, y and z in some order, each perhaps with a minus";
    const auto words = table.texts("axes");
    std::array<int, 3> axes{};
    std::array<int, 3> uses{};
    if (words.size() != axes.size()) {
        table.refuse("axes", expected);
    }
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const bool turned = words[i].starts_with('-');
        const auto letter = std::string_view{words[i]}.substr(turned ? 1 : 0);
        const auto axis = std::string_view{"xyz"}.find(letter);
        if (letter.size() != 1 || axis == std::string_view::npos || uses[axis]++ > 0) {
            table.refuse("axes", expected);
        }
        axes[i] = (turned ? -1 : 1) * static_cast<int>(axis + 1);
    }
    return axes;
}

} // namespace macadam
