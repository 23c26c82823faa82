#pragma once

/// Elementary functions that are the same on every machine, to the last bit: + - * / and sqrt only,
/// which IEEE 754 fixes. Those of the C library choose other instructions on other processors.
/// About 1e-15 relative. What is compiled from a formula must not be contracted to fused
/// operations either (-ffp-contract=off).
namespace macadam::exact {

double sin(double radians);     ///< |radians| <= 1e5
double cos(double radians);     ///< |radians| <= 1e5
double exp(double x);           ///< 0 below -708, infinity above 709
double log(double x);           ///< x > 0
double pow(double x, double y); ///< x > 0; relative error 1e-15 * (1 + |y log x|)
double atan2(double y, double x);

} // namespace macadam::exact
