#include "derivative.hpp"

#include <algorithm>
#include <cstring>

#include "../simd/kernels.hpp"
#include "hyst/bouc_wen_branch.h"
#include "hyst/jiles_atherton.h"
#include "hyst/langevin.h"
#include "hyst/power.h"
#include "hyst/root.h"

// What CMakeLists.txt compiles for each number of tangents, and for each instruction set with it.
#define HYST_PASS(name)             \
    namespace name {                \
    extern const Pass run_pass; \
    }
#if defined(HYST_X86)
#define HYST_WIDER(name) HYST_PASS(name##_avx2) HYST_PASS(name##_avx512)
#define HYST_PASSES(name) name##_avx512::run_pass, name##_avx2::run_pass, name::run_pass
#else
#define HYST_WIDER(name)
#define HYST_PASSES(name) nullptr, nullptr, name::run_pass
#endif
#define HYST_WIDTH(name)                                                                       \
    HYST_PASS(name)                                                                            \
    HYST_WIDER(name)                                                                           \
    namespace name {                                                                           \
    void run_columns(const Said &said, const Remembered &memory, const double *start,          \
                     const Columns &columns, Pass run);                                        \
    }

namespace hyst {

HYST_WIDTH(tangents_4)
HYST_WIDTH(tangents_8)
HYST_WIDTH(tangents_16)

namespace {

struct Width {
    std::size_t tangents;
    void (*run_columns)(const Said &, const Remembered &, const double *, const Columns &, Pass);
    Pass avx512, avx2, baseline;

    Pass in_use() const {
        const char *name = kernels().name;
        return std::strcmp(name, "avx512") == 0 ? avx512
               : std::strcmp(name, "avx2") == 0 ? avx2
                                                : baseline;
    }
};

// Narrow ones first: what is left takes the first that holds it.
const Width kWidths[] = {{4, tangents_4::run_columns, HYST_PASSES(tangents_4)},
                         {8, tangents_8::run_columns, HYST_PASSES(tangents_8)},
                         {16, tangents_16::run_columns, HYST_PASSES(tangents_16)}};

const Width &width_for(std::size_t columns) {
    for (const Width &each : kWidths) {
        if (columns <= each.tangents) return each;
    }
    return kWidths[2];
}

}  // namespace

double core_power(double x, double e) { return hyst_power(x, e); }
double core_log2(double x) { return hyst_log2(x); }
double core_langevin(double x) { return hyst_langevin(x); }
double core_langevin_slope(double x) { return hyst_langevin_slope(x); }
double core_langevin_inverse(double v) { return hyst_langevin_inverse(v); }
double core_jiles_root(int variant, int loses, const double *constants, int rests, const double *stretch,
                       double target, const double *ends) {
    hyst_jiles_atherton of{};
    of.variant = static_cast<hyst_jiles_variant>(variant);
    of.loses = loses;
    of.eta = constants[0];
    of.kappa = constants[1];
    of.c = constants[2];
    of.width = constants[3];
    of.reach = constants[4];
    of.x_share = constants[5];
    of.m_share = constants[6];
    const hyst_jiles_stretch on = {&of,        rests,      stretch[0], stretch[1],
                                   stretch[2], stretch[3], stretch[4], stretch[5],
                                   stretch[6], stretch[7], stretch[8]};
    return hyst_jiles_root(&on, target, ends[0], ends[1], ends[2], ends[3]);
}
double core_exp2(double v) { return hyst_exp2(v); }
double core_root(double x) { return hyst_root(x); }

double core_rising(double n, double join, double share) {
    return hyst_bouc_wen_rising(n, join, share);
}
double core_falling(double n, double ratio, double share) {
    return hyst_bouc_wen_falling(n, ratio, share);
}
double core_risen(double n, double join, double tilt, double from, double way) {
    return hyst_bouc_wen_risen(n, join, tilt, from, way);
}
double core_fallen(double n, double ratio, double tilt, double from, double way) {
    return hyst_bouc_wen_fallen(n, ratio, tilt, from, way);
}

void kernel_jacobian(const Said &said, const Remembered &memory, std::size_t length,
                     const Tangents &t) {
    const std::size_t columns = t.incoming + said.constants.size();
    std::vector<double> y(t.samples);
    // Every group of columns starts from here, while the memory goes on.
    const std::vector<double> start(memory.state, memory.state + length);
    std::size_t first = 0;
    do {
        const Width &width = width_for(columns - first);
        const std::size_t count = std::min(width.tangents, columns - first);
        const Columns at{t.signal, y.data(), t.rows, t.samples, t.stride, t.incoming, first, count};
        width.run_columns(said, memory, start.data(), at, width.in_use());
        first += count;
    } while (first < columns);
    std::copy(y.begin(), y.end(), t.signal);
}

}  // namespace hyst
