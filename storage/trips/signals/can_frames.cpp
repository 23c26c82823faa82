#include "storage/trips/signals/can_frames.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/foreign/time_parsing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

using Line = CanFrames::Line;

constexpr double first_utc_s = 631152000; // 1990-01-01: smaller times count from the start
constexpr std::uint32_t max_extended_id = 0x1FFFFFFF;
constexpr std::uint32_t max_standard_id = 0x7FF;
constexpr std::uint8_t max_size = 64;

std::string_view take_word(std::string_view& line) {
    line = trimmed(line);
    const auto word = line.substr(0, line.find_first_of(" \t"));
    line.remove_prefix(word.size());
    return word;
}

/// Parses the identifier of a frame.
bool set_id(std::string_view text, int base, bool is_extended, CanFrame& frame) {
    const auto id = exact_number<std::uint32_t>(text, base);
    if (!id || *id > (is_extended ? max_extended_id : max_standard_id)) {
        return false;
    }
    frame.id = *id;
    frame.is_extended = is_extended;
    return true;
}

/// Parses bytes as words; every frame has `count` of them.
bool set_bytes(std::string_view rest, std::size_t count, int base, CanFrame& frame) {
    frame.size = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto byte = exact_number<std::uint32_t>(take_word(rest), base);
        if (!byte || *byte > 0xFF || frame.size == max_size) {
            return false;
        }
        frame.bytes[frame.size++] = static_cast<std::uint8_t>(*byte);
    }
    return true;
}

/// Parses "08FF12", in which dots may stand between bytes.
bool set_packed(std::string_view digits, CanFrame& frame) {
    frame.size = 0;
    while (!digits.empty()) {
        if (digits.front() == '.') {
            digits.remove_prefix(1);
            continue;
        }
        const auto byte = exact_number<std::uint32_t>(digits.substr(0, 2), 16);
        if (!byte || digits.size() < 2 || frame.size == max_size) {
            return false;
        }
        frame.bytes[frame.size++] = static_cast<std::uint8_t>(*byte);
        digits.remove_prefix(2);
    }
    return true;
}

/// Date of an ASC file: "Thu Apr 20 10:49:00.000 am 2006", in English or German, without the day
/// of the week as well.
std::optional<double> date_s(std::string_view words, double utc_offset_s) {
    std::string clock;
    std::string half;
    std::string year;
    std::string month;
    std::string day;
    while (!trimmed(words).empty()) {
        const auto word = take_word(words);
        const auto lower = in_lower_case(word);
        const auto number = exact_number<std::uint32_t>(word, 10);
        if (word.find(':') != std::string_view::npos) {
            clock = word;
        } else if (lower == "am" || lower == "pm") {
            half = lower;
        } else if (number && *number > 31) {
            year = word;
        } else if (number) {
            day = word;
        } else {
            month = word; // the last name: the first is the day of the week
        }
    }
    const TimeMapping mapping{.columns = {},
                              .format = TimeFormat::day_month_year,
                              .unit_s = 1,
                              .since_1970 = false,
                              .utc_offset_s = utc_offset_s,
                              .fraction_s = {},
                              .shift_s = 0};
    const auto time =
        parse_time(fmt::format("{} {} {} {} {}", day, month, year, clock, half), mapping);
    return time ? std::optional{time->s} : std::nullopt;
}

} // namespace

CanFrames::CanFrames(TextLines lines, std::optional<double> utc_offset_s)
    : lines_{std::move(lines)}, utc_offset_s_{utc_offset_s} {}

std::optional<Line> CanFrames::next() {
    while (const auto text = lines_.next()) {
        const auto line = trimmed(*text);
        if (line.empty()) {
            continue;
        }
        if (asc_head(line)) {
            return Line::other;
        }
        return is_asc_ ? asc_line(line) : candump_line(line);
    }
    return std::nullopt;
}

/// (1533226488.23) can0 260#08FF, 1F334455##1AABB (CAN FD), 123#R (remote), or
/// (1533226488.23) can0 260 [2] 08 FF
Line CanFrames::candump_line(std::string_view line) {
    const auto close = line.find(')');
    if (!line.starts_with('(') || close == std::string_view::npos) {
        return line.starts_with('#') ? Line::other : Line::damaged;
    }
    const auto time = parse_number(line.substr(1, close - 1));
    line.remove_prefix(close + 1);
    frame_.bus = take_word(line);
    auto word = take_word(line);
    const auto hash = word.find('#');
    const auto id = word.substr(0, hash);
    if (!time || !std::isfinite(*time) || frame_.bus.empty()) {
        return Line::damaged;
    }
    frame_.t_s = *time;
    dated_ = dated_ || *time >= first_utc_s;
    if (id.size() == 8 && exact_number<std::uint32_t>(id, 16).value_or(0) > max_extended_id) {
        return Line::other; // an error frame
    }
    if (!set_id(id, 16, id.size() == 8, frame_)) {
        return Line::damaged;
    }
    if (hash == std::string_view::npos) {
        const auto length = take_word(line); // "[8]"
        if (trimmed(line).starts_with("remote")) {
            return Line::other;
        }
        const bool is_length = length.size() > 2 && length.front() == '[' && length.back() == ']';
        const auto count =
            exact_number<std::uint32_t>(is_length ? length.substr(1, length.size() - 2) : "", 10)
                .value_or(max_size + 1);
        return count <= max_size && set_bytes(line, count, 16, frame_) ? Line::frame
                                                                       : Line::damaged;
    }
    word.remove_prefix(hash + 1);
    if (word.starts_with('R')) {
        return Line::other;
    }
    if (word.starts_with('#')) { // CAN FD: a digit of flags
        word.remove_prefix(std::min<std::size_t>(word.size(), 2));
    }
    word = word.substr(0, word.find('_')); // raw length code of eight bytes
    return set_packed(word, frame_) ? Line::frame : Line::damaged;
}

/// Takes a line above or between the events of an ASC file.
bool CanFrames::asc_head(std::string_view line) {
    auto rest = line;
    const auto first = in_lower_case(take_word(rest));
    if (first == "date" || first == "base") {
        is_asc_ = true;
    }
    if (!is_asc_) {
        return false;
    }
    const bool is_begin = first == "begin" && in_lower_case(take_word(rest)) == "triggerblock";
    if ((first == "date" || is_begin) && utc_offset_s_) { // of the file, of the measurement
        if (const auto begin_s = date_s(rest, *utc_offset_s_)) {
            begin_s_ = *begin_s;
            dated_ = true;
        }
    }
    if (first == "base") {
        is_hex_ = in_lower_case(take_word(rest)) != "dec";
        is_relative_ = in_lower_case(rest).find("relative") != std::string::npos;
    }
    return first == "date" || first == "base" || first == "begin" || first == "end" ||
           first == "internal" || first == "no" || first.starts_with("//");
}

Line CanFrames::asc_line(std::string_view line) {
    const auto time = parse_number(take_word(line));
    if (!time || !std::isfinite(*time)) {
        return Line::damaged;
    }
    now_s_ = is_relative_ ? now_s_ + *time : *time;
    frame_.t_s = begin_s_ + now_s_;
    return trimmed(line).starts_with("CANFD") ? asc_fd_frame(line) : asc_frame(line);
}

/// 1  123x  Rx  d 8 01 02 ...
Line CanFrames::asc_frame(std::string_view rest) {
    frame_.bus = take_word(rest);
    auto id = take_word(rest);
    const auto direction = take_word(rest);
    const auto kind = take_word(rest);
    if ((direction != "Rx" && direction != "Tx") || kind != "d") {
        return Line::other; // an event, an error, a remote frame
    }
    const bool is_extended = id.ends_with('x') || id.ends_with('X');
    id.remove_suffix(is_extended ? 1 : 0);
    const int base = is_hex_ ? 16 : 10;
    const auto count = exact_number<std::uint32_t>(take_word(rest), 16);
    return set_id(id, base, is_extended, frame_) && count && *count <= 15 &&
                   set_bytes(rest, std::min(*count, 8U), base, frame_)
               ? Line::frame
               : Line::damaged;
}

/// CANFD  1 Rx  123x  [Name]  1 0 d 32 01 02 ...: bit rate switch, error state, length code, length
Line CanFrames::asc_fd_frame(std::string_view rest) {
    take_word(rest);
    frame_.bus = take_word(rest);
    const auto direction = take_word(rest);
    auto id = take_word(rest);
    if ((direction != "Rx" && direction != "Tx") || id == "ErrorFrame") {
        return Line::other;
    }
    const bool is_extended = id.ends_with('x') || id.ends_with('X');
    id.remove_suffix(is_extended ? 1 : 0);
    const int base = is_hex_ ? 16 : 10;
    auto flag = take_word(rest);
    if (flag != "0" && flag != "1") {
        flag = take_word(rest); // behind the name of the message
    }
    const auto state = take_word(rest);
    const auto code = take_word(rest);
    const auto count = exact_number<std::uint32_t>(take_word(rest), 10);
    if (!set_id(id, base, is_extended, frame_) || flag.empty() || state.empty() || code.empty() ||
        !count || *count > max_size || !set_bytes(rest, *count, base, frame_)) {
        return Line::damaged;
    }
    return Line::frame;
}

} // namespace macadam
