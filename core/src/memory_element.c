/* Memory element, one sample at a time. */
#include "hyst/memory_element.h"

#include "hyst/power.h"

static hyst_real table(const hyst_memory_function *function, hyst_real p)
{
    size_t low = 0, high = function->count - 1u;
    if (!(p > function->knot[low])) {
        return function->value[low];
    }
    if (!(p < function->knot[high])) {
        return function->value[high];
    }
    while (high - low > 1u) {
        const size_t middle = low + (high - low) / 2u;
        if (function->knot[middle] <= p) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return function->value[low] + (function->value[high] - function->value[low]) *
                                      ((p - function->knot[low]) /
                                       (function->knot[high] - function->knot[low]));
}

hyst_real hyst_memory_value(const hyst_memory_function *function, hyst_real p)
{
    const hyst_real *value = function->value;
    switch (function->kind) {
    case HYST_MEMORY_TABLE:
        return table(function, p);
    case HYST_MEMORY_POLYNOMIAL: {
        hyst_real sum = HYST_REAL(0.0);
        for (size_t j = function->count; j > 0u; --j) {
            sum = sum * p + value[j - 1u];
        }
        return sum;
    }
    case HYST_MEMORY_POWER:
    default:
        return value[0] + value[1] * hyst_power(p < HYST_REAL(0.0) ? -p : p, value[2]);
    }
}

hyst_real hyst_memory_element_step(const hyst_memory_element *model, hyst_real *state,
                                   hyst_real input)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real sign = input > zero ? one : input < zero ? -one : state[1];
    const int changes = model->is_reset && sign * state[1] < zero;
    const hyst_real p = changes ? model->reset_to : state[0];
    const hyst_real m = hyst_memory_value(&model->function, p);
    const hyst_real output = model->inverse ? input / m : input * m;
    const hyst_real u = model->inverse ? output : input;
    const hyst_real p_next = p + model->dt * (model->absolute && u < zero ? -u : u);
    /* A memory that overflows is answered like an output that does: by one that is not finite. */
    const hyst_real doubt = output - output + (p_next - p_next);
    if (!(doubt >= zero && doubt <= zero)) {
        return doubt;
    }
    state[0] = p_next;
    state[1] = sign;
    return output;
}

static size_t memory_element_length(const void *model)
{
    (void)model;
    return 2;
}

static hyst_real memory_element_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_memory_element_step((const hyst_memory_element *)model, state, u);
}

const hyst_kind hyst_memory_element_kind = {memory_element_length, memory_element_step};
