/* The polynomial of an input and of what its hysteresis has made of it. */
#include "hyst/state_polynomial.h"

hyst_real hyst_state_polynomial_value(const hyst_state_polynomial *map, hyst_real u, hyst_real z)
{
    const size_t rows = map->degree + 1u;
    const hyst_real *end = map->coefficient + rows * (rows + 1u) / 2u;
    hyst_real y = HYST_REAL(0.0);
    for (size_t i = rows; i > 0u; --i) {
        const size_t count = rows + 1u - i;
        hyst_real row = HYST_REAL(0.0);
        end -= count;
        for (size_t j = count; j > 0u; --j) {
            row = row * z + end[j - 1u];
        }
        y = y * u + row;
    }
    return y;
}
