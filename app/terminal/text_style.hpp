#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {

/// Emphasis of text for people.
enum class TextStyle : std::uint8_t {
    heading, ///< bold
    good,    ///< green
    warning, ///< yellow
    error    ///< red
};

/// Tests whether text on this stream (STDOUT_FILENO or STDERR_FILENO) is coloured: on a terminal,
/// unless the variable NO_COLOR is not empty (no-color.org) or TERM is "dumb". CLICOLOR_FORCE other
/// than 0 colours files and pipes, too; NO_COLOR outranks it.
bool is_coloured(int stream);

/// Wraps text in the escape sequences of a style (ECMA-48, SGR) if the stream is coloured. The text
/// must be printable already (app/cli/terminal_escape.hpp).
std::string styled(TextStyle style, std::string_view text, int stream);

} // namespace macadam
