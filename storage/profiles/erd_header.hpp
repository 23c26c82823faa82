#pragma once

#include "storage/profiles/fixed_fields.hpp"
#include "storage/tables/text_lines.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Storage of the numbers of an ERD file: the "key number" of its second line.
enum class ErdNumbers : std::uint8_t {
    int16 = 0,   ///< in a .bin beside the header
    float32 = 1, ///< in a .bin beside the header
    text = 5,    ///< in the lines after END
};

/// Header of an ERD file of version 2.00.
///
/// Source: UMTRI, "The ERD File Specification"; M. W. Sayers, "ERD Data-Processing Software
/// Reference Manual, Version 2.00", UMTRI-87-2 (1987).
struct ErdHeader {
    struct Channel {
        std::string name; ///< SHORTNAM, at most 8 characters, else LONGNAME, at most 32
        std::string unit; ///< UNITSNAM, at most 8 characters
        double gain = 1;  ///< GAIN: units per count of integer data
    };
    std::vector<Channel> channels;      ///< at least one
    std::optional<std::size_t> samples; ///< per channel; `std::nullopt`: as many as the file holds
    ErdNumbers numbers;
    std::optional<double> step_m; ///< `std::nullopt`: XUNITS is not a length, or the step is 0
    double start_m = 0;           ///< XSTART, in XUNITS; not written by our own writer
    std::string title;
    std::vector<FixedField> format; ///< FORMAT of a text line; empty: separated by blanks
};

/// Reads the header up to and including the line END.
///
/// \throws InputError  "file:line: ..." for an invalid header.
ErdHeader read_erd_header(TextLines& lines);

} // namespace macadam
