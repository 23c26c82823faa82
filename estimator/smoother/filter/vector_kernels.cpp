#include "estimator/smoother/filter/vector_kernels.hpp"

// Clones functions for wider registers; the choice is made at program start. Sanitizers are
// initialised after that choice and crash in it; Clang has another syntax.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&                  \
    defined(__x86_64__)
#define MACADAM_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define MACADAM_WIDE
#endif

namespace macadam::wide {

MACADAM_WIDE void copy_times(double* to, double by, const double* from, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        to[j] = by * from[j];
    }
}

MACADAM_WIDE void add(double* to, double by, const double* from, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        to[j] += by * from[j];
    }
}

MACADAM_WIDE void combine(double* to,
                          const double* const* rows,
                          const double* weights,
                          std::size_t terms,
                          std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        to[j] = 0;
    }
    for (std::size_t k = 0; k < terms; ++k) {
        const double weight = weights[k];
        const double* row = rows[k];
        for (std::size_t j = 0; j < n; ++j) {
            to[j] += weight * row[j];
        }
    }
}

MACADAM_WIDE void downdate(double* matrix, const double* vector, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        double* row = matrix + i * n;
        const double by = vector[i];
        for (std::size_t j = 0; j < n; ++j) {
            row[j] -= by * vector[j];
        }
    }
}

} // namespace macadam::wide
