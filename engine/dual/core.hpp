// The core's stages with tangents: their own sources once more, in a namespace, HYST_KINDS, that
// names how many tangents and which instruction set. A translation unit that includes this has no
// other core.
//
// Only functions of C are called, so that no inline function of the standard library is compiled
// for one instruction set and used in another (docs/decisions/0010).
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#ifdef HYST_TAPE
#define HYST_REAL_HEADER "dual/tape.h"
#else
#define HYST_REAL_HEADER "dual/real.h"
#endif
#define HYST_POWER_HEADER "dual/power.h"
#define HYST_ROOT_HEADER "dual/root.h"

namespace hyst {

// hyst_power, hyst_log2 and hyst_exp2 of the core in double.
double core_power(double x, double e);
double core_log2(double x);
double core_exp2(double v);
// hyst_root likewise.
double core_root(double x);

// Ways and shares of Bouc-Wen's branches in double; hyst/bouc_wen_branch.h.
double core_rising(double n, double join, double share);
double core_falling(double n, double ratio, double share);
double core_risen(double n, double join, double tilt, double from, double way);
double core_fallen(double n, double ratio, double tilt, double from, double way);

// The Langevin function and a root on a branch of Jiles and Atherton's in double.
double core_langevin(double x);
double core_langevin_slope(double x);
double core_langevin_inverse(double v);
double core_jiles_root(int variant, int loses, const double *constants, int rests, const double *stretch,
                       double target, const double *ends);

namespace HYST_KINDS {

// What solves an equation by iteration is differentiated by the implicit function theorem instead:
// from f(x) = w, df + f'(x) dx = dw. The derivative of the last iterate would lag behind its value
// by up to the square of the tolerance, and the iteration would carry tangents for nothing.
//
// Each kind with something to iterate has its rule in a file of dual/rules, and names there what of the
// core it stands for.
#include "rules.inc"       // made by CMakeLists.txt: the files of dual/rules
#include "core_kinds.inc"  // made by CMakeLists.txt: the sources that hold a kind, and the kinds

#undef hyst_masing_step

}  // namespace HYST_KINDS
}  // namespace hyst
