#pragma once

#include "storage/tables/text_lines.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Frame of a CAN bus.
struct CanFrame {
    double t_s = 0; ///< of the log: since 1970 (CanFrames::dated), or since its start
    std::uint32_t id = 0;
    bool is_extended = false;
    std::string bus; ///< "can0", or the channel of an ASC file: "1"
    std::uint8_t size = 0;
    std::array<std::uint8_t, 64> bytes{};

    std::span<const std::uint8_t> data() const { return {bytes.data(), size}; }
};

/// Reads the frames of a text log, line by line: candump (`candump -l`, and its output on a console
/// with a time in parentheses) or Vector ASC; classical frames and CAN FD.
///
/// Sources: can-utils, comments of candump.c and lib.h (format of compact CAN frames); Vector
/// Informatik, "CAN and LIN logging formats in ASCII".
class CanFrames {
public:
    enum class Line : std::uint8_t {
        frame,
        other,   ///< a remark, an event, a frame without data (remote, error)
        damaged, ///< a frame that cannot be parsed
    };

    /// \param utc_offset_s  local time minus UTC of the date line of an ASC file
    CanFrames(TextLines lines, std::optional<double> utc_offset_s);

    /// Next line that is not blank; `std::nullopt` at the end.
    std::optional<Line> next();

    const CanFrame& frame() const { return frame_; } ///< of the last line
    bool dated() const { return dated_; }            ///< whether times so far are UTC

private:
    Line candump_line(std::string_view line);
    Line asc_line(std::string_view line);
    Line asc_frame(std::string_view rest);
    Line asc_fd_frame(std::string_view rest);
    bool asc_head(std::string_view line);

    TextLines lines_;
    std::optional<double> utc_offset_s_;
    CanFrame frame_;
    bool is_asc_ = false;
    bool is_hex_ = true;
    bool is_relative_ = false;
    double begin_s_ = 0; ///< UTC of the date line
    double now_s_ = 0;   ///< since it
    bool dated_ = false;
};

} // namespace macadam
