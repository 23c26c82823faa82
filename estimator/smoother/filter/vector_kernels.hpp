#pragma once

#include <cstddef>

/// Inner loops of the filter. Each number is computed by itself, without sums across a vector or
/// contraction, so that registers of any width give the same bits.
namespace macadam::wide {

/// to = by * from; the two may be identical.
void copy_times(double* to, double by, const double* from, std::size_t n);

/// to += by * from.
void add(double* to, double by, const double* from, std::size_t n);

/// to = sum of weight * row.
void combine(
    double* to, const double* const* rows, const double* weights, std::size_t terms, std::size_t n);

/// matrix -= vector * transposed vector, n * n.
void downdate(double* matrix, const double* vector, std::size_t n);

} // namespace macadam::wide
