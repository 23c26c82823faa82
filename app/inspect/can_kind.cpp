#include "app/inspect/can_kind.hpp"

#include "estimator/common/ascii.hpp"
#include "storage/files/decompress.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/mappings/dbc.hpp"
#include "storage/trips/signals/mdf_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace macadam {
namespace {

constexpr std::size_t max_lines = 40;

/// First lines without blanks at their ends, of those that are not empty.
std::vector<std::string_view> first_lines(std::string_view head) {
    std::vector<std::string_view> lines;
    while (!head.empty() && lines.size() < max_lines) {
        const auto end = std::min(head.find('\n'), head.size());
        if (const auto line = trimmed(head.substr(0, end)); !line.empty()) {
            lines.push_back(line);
        }
        head.remove_prefix(std::min(end + 1, head.size()));
    }
    return lines;
}

/// Takes the first word off a line; "" at its end.
std::string_view take_word(std::string_view& line) {
    line = trimmed(line);
    const auto word = line.substr(0, line.find_first_of(" \t"));
    line.remove_prefix(word.size());
    return word;
}

bool is_identifier(std::string_view text) { // of a frame: 11 or 29 bits
    return !text.empty() && text.size() <= 8 &&
           std::ranges::all_of(text, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// Takes the time in parentheses off a line, if there is one.
void drop_time(std::string_view& line) {
    const auto end = line.find_first_not_of("0123456789.:- ", 1);
    if (line.starts_with('(') && end != std::string_view::npos && line[end] == ')') {
        line.remove_prefix(end + 1);
    }
}

/// Tests for "[8]".
bool is_length(std::string_view word) {
    return word.size() > 2 && word.starts_with('[') &&
           word.find_first_not_of("0123456789", 1) == word.size() - 1 && word.ends_with(']');
}

/// Tests for "(1533226488.23) can0 260#08FF" and "can0 260 [2] 08 FF", with or without a time.
bool is_candump_line(std::string_view line) {
    drop_time(line);
    const auto bus = take_word(line);
    const auto frame = take_word(line);
    const auto hash = frame.find('#');
    return !bus.empty() && is_identifier(frame.substr(0, hash)) &&
           (hash != std::string_view::npos || is_length(take_word(line)));
}

bool is_candump(const std::vector<std::string_view>& lines) {
    const auto count = std::ranges::count_if(lines, is_candump_line);
    return count > 0 && static_cast<std::size_t>(count) * 2 > lines.size();
}

/// Tests for "base hex timestamps absolute" below a date.
bool is_vector_asc(const std::vector<std::string_view>& lines) {
    return std::ranges::any_of(lines, [](std::string_view line) {
        const auto base = in_lower_case(take_word(line));
        const auto number = in_lower_case(take_word(line));
        return base == "base" && (number == "hex" || number == "dec") &&
               in_lower_case(take_word(line)) == "timestamps";
    });
}

bool is_peak_trc(const std::vector<std::string_view>& lines) {
    return !lines.empty() && lines.front().starts_with(';') &&
           std::ranges::any_of(lines, [](std::string_view line) {
               return line.starts_with(";$FILEVERSION=") ||
                      (line.starts_with(';') && line.find("PCAN") != std::string_view::npos);
           });
}

bool is_dbc(const std::vector<std::string_view>& lines) {
    constexpr std::array<std::string_view, 4> keywords{"NS_ :", "BS_:", "BU_:", "BO_ "};
    const auto count = std::ranges::count_if(keywords, [&](std::string_view keyword) {
        return std::ranges::any_of(
            lines, [&](std::string_view line) { return line.starts_with(keyword); });
    });
    return count >= 2 || (count == 1 && lines.front().starts_with("VERSION \""));
}

/// Names for people, of those that can be shown.
std::string some_of(std::vector<std::string> names, std::string_view one) {
    constexpr std::size_t max_shown = 60;
    constexpr std::size_t longest = 80;
    const auto count = names.size();
    names.resize(std::min(count, max_shown));
    std::string words;
    for (const auto& name : names) {
        const auto quoted = in_quotes(name, longest); // with other bytes as \x00
        words += (words.empty() ? "" : ", ") + quoted.substr(1, quoted.size() - 2);
    }
    return fmt::format("{} {}{}: {}{}",
                       count,
                       one,
                       count == 1 ? "" : "s",
                       words,
                       count > max_shown ? fmt::format(" and {} more", count - max_shown) : "");
}

} // namespace

FileKind kind_of_mdf(const std::filesystem::path& file) {
    std::string content;
    std::vector<char> block(1 << 20);
    const auto bytes = decompressed(file_bytes(file), file.string());
    while (const auto count = bytes->read(block)) {
        content.append(block.data(), count);
    }
    const auto channels = mdf_channels(content, file.string());
    const bool has_frames = std::ranges::any_of(
        channels, [](const std::string& name) { return name.ends_with(can_frame_id); });
    if (has_frames) {
        return {
            FileKind::Use::other,
            "measurement file (ASAM MDF 4): raw frames of a CAN bus",
            "read with --mapping FILE.toml, whose table [mdf] names the description of the car's "
            "signals (dbc = \"car.dbc\"; docs/reference/other-loggers.md)"};
    }
    return {FileKind::Use::other,
            "measurement file (ASAM MDF 4), " + some_of(channels, "channel"),
            "read with --mapping FILE.toml, which has a table [mdf] and names the channels to take "
            "(docs/reference/other-loggers.md)"};
}

FileKind can_log_kind(std::string_view format, bool is_read) {
    return {FileKind::Use::other,
            fmt::format("CAN log ({}): raw frames{}", format, is_read ? "" : ", not read"),
            is_read ? "read with --mapping FILE.toml, which names the description of the car's "
                      "signals (.dbc) and the signals to take (docs/reference/other-loggers.md)"
                    : "convert it to candump or Vector ASC, then inspect that"};
}

std::optional<FileKind> kind_of_can_text(const std::filesystem::path& file, std::string_view head) {
    const auto lines = first_lines(head);
    if (is_vector_asc(lines)) {
        return can_log_kind("Vector ASC", true);
    }
    if (is_peak_trc(lines)) {
        return can_log_kind("PEAK TRC", false);
    }
    if (is_candump(lines)) {
        return can_log_kind("candump", true);
    }
    if (is_dbc(lines)) {
        return FileKind{FileKind::Use::other,
                        "description of CAN signals (DBC), " +
                            some_of(signal_names(read_dbc(file)), "signal"),
                        "a mapping for CAN logs names it: [can] dbc = \"FILE.dbc\" "
                        "(docs/reference/other-loggers.md)"};
    }
    return std::nullopt;
}

} // namespace macadam
