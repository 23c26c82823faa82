#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace macadam {

/// Number at a fixed position of a line.
struct FixedField {
    std::size_t from;
    std::size_t width;
    int decimals; ///< implied decimals of a number without a decimal point
};

/// Parses a Fortran FORMAT of F, E, D, G and I, X, scale factors, repetition and brackets:
/// "(2F8.3)", "(1X,3(E12.4,2X))". Empty for any other format.
std::vector<FixedField> fields_of_format(std::string_view format);

/// Parses a number in Fortran notation, in which D may replace E. Without a decimal point and an
/// exponent, the last `decimals` digits are the fraction. Returns `std::nullopt` if the text is not
/// a finite number.
std::optional<double> fortran_number(std::string_view text, int decimals = 0);

} // namespace macadam
