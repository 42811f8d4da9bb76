/* Linear part of a tracking controller, one sample at a time. In a file of its own, so that code that
 * calls the stages of its inverse directly needs no chain. */
#include "hyst/finite.h"
#include "hyst/tracking_controller.h"

hyst_real hyst_tracking_controller_linear(const hyst_tracking_controller *controller, hyst_real *x,
                                          hyst_real y_ref, hyst_real y)
{
    const size_t n = controller->order;
    hyst_real next[HYST_LARGEST_ORDER];
    hyst_real v = controller->d[0] * y_ref + controller->d[1] * y;
    for (size_t i = 0; i < n; ++i) {
        next[i] = controller->b[i] * y_ref + controller->b[n + i] * y;
    }
    /* Column after column: the sums of all rows run side by side. */
    for (size_t j = 0; j < n; ++j) {
        const hyst_real *column = controller->a + j * n;
        const hyst_real xj = x[j];
        v += controller->c[j] * xj;
        for (size_t i = 0; i < n; ++i) {
            next[i] += column[i] * xj;
        }
    }
    hyst_real zero = v - v; /* unless something is not finite: then NaN */
    for (size_t i = 0; i < n; ++i) {
        zero += next[i] - next[i];
    }
    const int finite = hyst_is_finite(zero);
    for (size_t i = 0; i < n; ++i) {
        x[i] = finite ? next[i] : x[i];
    }
    return finite ? v : zero;
}

void hyst_tracking_take_back(size_t order, const hyst_real *w, hyst_real *x, hyst_real excess)
{
    hyst_real zero = HYST_REAL(0.0); /* unless something is not finite: then NaN */
    for (size_t i = 0; i < order; ++i) {
        const hyst_real next = x[i] + w[i] * excess;
        zero += next - next;
    }
    /* Nothing is added where there is nothing: -0 stays -0. */
    if (((excess < HYST_REAL(0.0)) || (excess > HYST_REAL(0.0))) && (hyst_is_finite(zero) != 0)) {
        for (size_t i = 0; i < order; ++i) {
            x[i] += w[i] * excess;
        }
    }
}
