// The derivative of a linear system's output by one of its constants is the output of the same
// system with another forcing: dx' = A dx + dA x + db w, dy = c dx + dc x + dd w.
#include <algorithm>
#include <vector>

#include "hyst/linear_dynamics.h"
#include "linear.hpp"

namespace hyst {
namespace {

// Delay the signal and its incoming tangents; the line holds what came before, which depends on
// nothing.
void delay(const double *line, std::size_t delay, const Tangents &t) {
    for (std::size_t k = t.samples; k-- > 0 && delay > 0;) {
        double *row = t.rows + k * t.stride;
        if (k >= delay) {
            t.signal[k] = t.signal[k - delay];
            std::copy_n(row - delay * t.stride, t.incoming, row);
        } else {
            t.signal[k] = line[k];
            std::fill_n(row, t.incoming, 0.0);
        }
    }
}

// Where a state space is, and the derivatives of its state: n rows of `width` columns, one for
// each incoming tangent, each entry of A and each entry of b.
struct SystemTangents {
    const hyst_state_space &system;
    std::size_t incoming, width;
    std::vector<double> x, x_next, s, s_next;

    SystemTangents(const hyst_state_space &given, const double *state, std::size_t incoming_columns)
        : system(given),
          incoming(incoming_columns),
          width(incoming_columns + (given.order + 1) * given.order),
          x(state, state + given.order),
          x_next(given.order),
          s(given.order * width),
          s_next(s.size()) {}

    // Turns a row of incoming tangents into the row of the output, and w into y.
    double output(double w, double *row) const {
        const std::size_t n = system.order;
        double y = system.d * w;
        for (std::size_t p = 0; p < incoming; ++p) row[p] *= system.d;
        std::fill_n(row + incoming, width - incoming, 0.0);
        for (std::size_t j = 0; j < n; ++j) {
            y += system.c[j] * x[j];
            for (std::size_t p = 0; p < width; ++p) row[p] += system.c[j] * s[j * width + p];
            row[width + j] = x[j];
        }
        row[width + n] = w;
        return y;
    }

    void advance(double w, const double *incoming_row) {
        const std::size_t n = system.order;
        for (std::size_t i = 0; i < n; ++i) {
            double *to = s_next.data() + i * width;
            x_next[i] = system.b[i] * w;
            for (std::size_t p = 0; p < width; ++p) {
                to[p] = p < incoming ? system.b[i] * incoming_row[p] : 0.0;
            }
            for (std::size_t j = 0; j < n; ++j) {
                const double a = system.a[j * n + i];
                x_next[i] += a * x[j];
                for (std::size_t p = 0; p < width; ++p) to[p] += a * s[j * width + p];
                to[incoming + i * n + j] += x[j];
            }
            to[incoming + n * n + i] += w;
        }
        x.swap(x_next);
        s.swap(s_next);
    }
};

void section_jacobian(const double *coefficient, const double *state, const Tangents &t,
                      std::size_t own) {
    const double b0 = coefficient[0], b1 = coefficient[1], b2 = coefficient[2];
    const double a1 = coefficient[3], a2 = coefficient[4];
    const std::size_t width = own + 5;
    double first = state[0], second = state[1];
    std::vector<double> d1(width), d2(width);
    for (std::size_t k = 0; k < t.samples; ++k) {
        double *row = t.rows + k * t.stride;
        const double u = t.signal[k], y = b0 * u + first;
        std::fill_n(row + own, 5, 0.0);
        for (std::size_t p = 0; p < width; ++p) {
            const double du = row[p];
            row[p] = b0 * du + d1[p] + (p == own ? u : 0.0);
            d1[p] = b1 * du - a1 * row[p] + d2[p];
            d2[p] = b2 * du - a2 * row[p];
        }
        d1[own + 1] += u;
        d2[own + 2] += u;
        d1[own + 3] -= y;
        d2[own + 4] -= y;
        first = b1 * u - a1 * y + second;
        second = b2 * u - a2 * y;
        t.signal[k] = y;
    }
}

}  // namespace

void state_space_jacobian(const void *model, double, const double *state, const Tangents &t) {
    const hyst_state_space &system = *static_cast<const hyst_state_space *>(model);
    delay(state + system.order, system.delay, t);
    SystemTangents tangents(system, state, t.incoming);
    std::vector<double> incoming(t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        double *row = t.rows + k * t.stride;
        const double w = t.signal[k];
        std::copy_n(row, t.incoming, incoming.data());
        t.signal[k] = tangents.output(w, row);
        tangents.advance(w, incoming.data());
    }
}

void sections_jacobian(const void *model, double, const double *state, const Tangents &t) {
    const hyst_sections &sections = *static_cast<const hyst_sections *>(model);
    for (std::size_t i = 0; i < sections.count; ++i) {
        section_jacobian(sections.coefficient + 5 * i, state + 2 * i, t, t.incoming + 5 * i);
    }
}

}  // namespace hyst
