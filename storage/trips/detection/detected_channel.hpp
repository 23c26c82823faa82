#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

/// Confidence in a reading of a column.
enum class Confidence : std::uint8_t {
    likely, ///< name or values suggest it
    sure,   ///< name and values agree, or the values allow one reading only
};

inline bool is_at_least(Confidence confidence, Confidence least) {
    return confidence == Confidence::sure || least == Confidence::likely;
}

/// Column that was read as a channel of the trip log.
struct DetectedChannel {
    std::string channel{}; ///< "acc_z_mps2"
    std::size_t column;    ///< number, from 1
    std::string unit{};    ///< word of mapping files; "": none
    double scale = 1;
    int sign = 1;
    bool minus_one_is_none = false;          ///< -1 stands for an unknown value
    std::optional<std::size_t> hemisphere{}; ///< number of its column
    Confidence confidence = Confidence::likely;
    std::string reason{}; ///< for people
};

} // namespace macadam
