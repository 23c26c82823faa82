#pragma once

/// Elementary functions with bit-identical results on every machine: they use only + - * / and
/// sqrt, which IEEE 754 fixes. The C library selects different instructions on different
/// processors. Relative error about 1e-15. Code compiled from a formula must not be contracted to
/// fused operations either (-ffp-contract=off).
namespace macadam::exact {

double sin(double radians);     ///< |radians| <= 1e5
double cos(double radians);     ///< |radians| <= 1e5
double exp(double x);           ///< 0 below -708, infinity above 709
double log(double x);           ///< x > 0
double pow(double x, double y); ///< x > 0; relative error 1e-15 * (1 + |y log x|)
double atan2(double y, double x);

} // namespace macadam::exact
