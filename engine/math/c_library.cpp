// The elementary functions of the C library, in all of the program and in what it is linked with.
//
// A C library has several of each and chooses by the instructions of the processor: with a fused multiplication and
// addition the last bits are others, and a search that compares thousands of numbers makes more of them. These are
// SLEEF's for single numbers, which have one set of instructions, that of every x86-64 processor, and err by no more than
// one unit in the last place (1.5 for erfc). A program that defines a function of a shared library uses its own.
// tests/cli/reproducible_test.py tells which function is missing here.
#include <math.h>
#include <sleef.h>

extern "C" {

double exp(double x) noexcept { return Sleef_exp_u10(x); }
double expm1(double x) noexcept { return Sleef_expm1_u10(x); }
double log(double x) noexcept { return Sleef_log_u10(x); }
double log10(double x) noexcept { return Sleef_log10_u10(x); }
double log1p(double x) noexcept { return Sleef_log1p_u10(x); }
double pow(double x, double y) noexcept { return Sleef_pow_u10(x, y); }
double cbrt(double x) noexcept { return Sleef_cbrt_u10(x); }
double hypot(double x, double y) noexcept { return Sleef_hypot_u05(x, y); }

double sin(double x) noexcept { return Sleef_sin_u10(x); }
double cos(double x) noexcept { return Sleef_cos_u10(x); }
double tan(double x) noexcept { return Sleef_tan_u10(x); }
double asin(double x) noexcept { return Sleef_asin_u10(x); }
double acos(double x) noexcept { return Sleef_acos_u10(x); }
double atan(double x) noexcept { return Sleef_atan_u10(x); }
double atan2(double y, double x) noexcept { return Sleef_atan2_u10(y, x); }
/// Compilers call it where both are asked for.
void sincos(double x, double* s, double* c) noexcept {
  *s = Sleef_sin_u10(x);
  *c = Sleef_cos_u10(x);
}

double erfc(double x) noexcept { return Sleef_erfc_u15(x); }
double lgamma(double x) noexcept { return Sleef_lgamma_u10(x); }

}  // extern "C"
