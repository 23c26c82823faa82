#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace macadam {

/// A number at a fixed place of a line.
struct FixedField {
    std::size_t from;
    std::size_t width;
    int decimals; ///< that a number without a point has
};

/// The fields of a line that was written with a Fortran FORMAT of F, E, D, G and I, X, scale
/// factors, repetition and brackets: "(2F8.3)", "(1X,3(E12.4,2X))". Empty if it is none of these.
std::vector<FixedField> fields_of_format(std::string_view format);

/// A number as Fortran writes it: D for E, too. Without a point and an exponent, the last
/// `decimals` of its digits stand behind the point. Nothing if it is none, or not finite.
std::optional<double> fortran_number(std::string_view text, int decimals = 0);

} // namespace macadam
