/* A bank of plays whose output is limited, one sample at a time. */
#include "hyst/limited_bank.h"

#include "hyst/finite.h"
#include "hyst/solved.h"

hyst_real hyst_limited_bank_step(const hyst_pi *bank, const hyst_bank_limits *limits,
                                 hyst_real *state, hyst_real *before, int *held, hyst_real v)
{
    const size_t count = bank->count;
    hyst_real *const last = state + count;
    for (size_t i = 0; i < count; ++i) {
        before[i] = state[i];
    }
    hyst_real u = hyst_pi_step(bank, state, v);
    int refused = 0;
    if (hyst_is_finite(u) == 0) { /* no drive belongs to v: the last one is kept */
        u = *last;
        refused = 1;
    }
    const hyst_real drive = hyst_limited_drive(&limits->drive, last, u);
    if ((refused != 0) || (drive < u) || (drive > u)) {
        for (size_t i = 0; i < count; ++i) {
            state[i] = before[i];
        }
        (void)hyst_pi_solved_step(bank, state, drive);
        *held = 1;
    }
    return drive;
}
