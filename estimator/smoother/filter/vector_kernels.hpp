#pragma once

#include <cstddef>

/// The filter's inner loops. Every number is computed by itself, no sum is taken across a vector
/// and nothing is contracted, so that any width of registers gives the same bits.
namespace macadam::wide {

/// to = by * from; the two may be one.
void copy_times(double* to, double by, const double* from, std::size_t n);

/// to += by * from.
void add(double* to, double by, const double* from, std::size_t n);

/// to = sum of weight * row.
void combine(
    double* to, const double* const* rows, const double* weights, std::size_t terms, std::size_t n);

/// matrix -= vector * transposed vector, n * n.
void downdate(double* matrix, const double* vector, std::size_t n);

} // namespace macadam::wide
