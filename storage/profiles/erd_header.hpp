#pragma once

#include "storage/profiles/fixed_fields.hpp"
#include "storage/tables/text_lines.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// How the numbers of an ERD file are stored: the "key number" of its second line.
enum class ErdNumbers : std::uint8_t {
    int16 = 0,   ///< in a .bin beside the header
    float32 = 1, ///< in a .bin beside the header
    text = 5,    ///< in the lines after END
};

/// The head of an ERD file of version 2.00.
///
/// Source: UMTRI, "The ERD File Specification"; M. W. Sayers, "ERD Data-Processing Software
/// Reference Manual, Version 2.00", UMTRI-87-2 (1987).
struct ErdHeader {
    struct Channel {
        std::string name; ///< SHORTNAM, at most 8 characters, else LONGNAME, at most 32
        std::string unit; ///< UNITSNAM, at most 8 characters
        double gain = 1;  ///< GAIN: units for a count of the integers
    };
    std::vector<Channel> channels;      ///< at least one
    std::optional<std::size_t> samples; ///< of each channel; nothing: as many as there are
    ErdNumbers numbers;
    std::optional<double> step_m; ///< nothing: XUNITS is no length, or 0
    double start_m = 0;           ///< XSTART, in XUNITS; our own writer leaves it
    std::string title;
    std::vector<FixedField> format; ///< FORMAT, of a line of text; empty: numbers stand apart
};

/// Reads up to and with the line END.
///
/// \throws InputError  "file:line: ..." for what no ERD file has.
ErdHeader read_erd_header(TextLines& lines);

} // namespace macadam
