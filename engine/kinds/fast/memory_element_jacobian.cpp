// The momentum p carries its derivatives along: dp' = dp + dt g'(u) du.
#include "hyst/memory_element.h"

#include <cmath>
#include <vector>

#include "memory_element.hpp"

namespace hyst {
namespace {

// M'(p) and M_theta(p).
struct MemorySlope {
    double by_p = 0.0;
    std::vector<double> by_constant;
};

void power(const double *c, double p, MemorySlope &at) {
    const double x = std::abs(p);
    const double raised = x > 0.0 ? std::pow(x, c[2]) : 0.0;
    at.by_constant = {1.0, raised, x > 0.0 ? c[1] * raised * std::log(x) : 0.0};
    at.by_p = x > 0.0 ? std::copysign(c[1] * c[2] * raised / x, p) : 0.0;
}

void polynomial(const hyst_memory_function &f, double p, MemorySlope &at) {
    double raised = 1.0;
    at.by_p = 0.0;
    for (std::size_t j = 0; j < f.count; ++j) {
        at.by_constant[j] = raised;
        raised *= p;
    }
    for (std::size_t j = f.count; j-- > 1;) {
        at.by_p = at.by_p * p + static_cast<double>(j) * f.value[j];
    }
}

void table(const hyst_memory_function &f, double p, MemorySlope &at) {
    at.by_constant.assign(f.count, 0.0);
    at.by_p = 0.0;
    std::size_t i = 0;
    while (i < f.count && f.knot[i] <= p) ++i;
    if (i == 0 || i == f.count) {
        at.by_constant[i == 0 ? 0 : f.count - 1] = 1.0;
        return;
    }
    const double width = f.knot[i] - f.knot[i - 1], share = (p - f.knot[i - 1]) / width;
    at.by_constant[i - 1] = 1.0 - share;
    at.by_constant[i] = share;
    at.by_p = (f.value[i] - f.value[i - 1]) / width;
}

void at_momentum(const hyst_memory_function &f, double p, MemorySlope &at) {
    switch (f.kind) {
    case HYST_MEMORY_POWER:
        return power(f.value, p, at);
    case HYST_MEMORY_POLYNOMIAL:
        return polynomial(f, p, at);
    case HYST_MEMORY_TABLE:
        return table(f, p, at);
    }
}

}  // namespace

void memory_element_jacobian(const void *of, double, const double *state, const Tangents &t) {
    const hyst_memory_element &model = *static_cast<const hyst_memory_element *>(of);
    const std::size_t own = model.function.count, width = t.incoming + own;
    double memory[2] = {state[0], state[1]};
    std::vector<double> p_tangent(width, 0.0);
    MemorySlope at;
    at.by_constant.resize(own);
    for (std::size_t k = 0; k < t.samples; ++k) {
        double *row = t.rows + k * t.stride;
        const double input = t.signal[k], sign = (input > 0.0) - (input < 0.0);
        const bool changes = model.is_reset && sign * memory[1] < 0.0;
        const double p = changes ? model.reset_to : memory[0];
        if (changes) p_tangent.assign(width, 0.0);
        const double m = hyst_memory_value(&model.function, p);
        const double output = hyst_memory_element_step(&model, memory, input);
        const double u = model.inverse ? output : input;
        const double toward_p = model.absolute && u < 0.0 ? -model.dt : model.dt;
        at_momentum(model.function, p, at);
        for (std::size_t c = 0; c < width; ++c) {
            const double by_own = c < t.incoming ? 0.0 : at.by_constant[c - t.incoming];
            const double input_tangent = c < t.incoming ? row[c] : 0.0;
            const double m_tangent = at.by_p * p_tangent[c] + by_own;
            row[c] = model.inverse ? (input_tangent - output * m_tangent) / m
                                   : input_tangent * m + input * m_tangent;
            p_tangent[c] += toward_p * (model.inverse ? row[c] : input_tangent);
        }
        t.signal[k] = output;
    }
}

}  // namespace hyst
