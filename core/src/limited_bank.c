/* A bank of plays whose output is limited, one sample at a time.
 *
 * On the way up the plays that move are the narrowest ones, so behind the first n of them the output is
 *
 *     u = (p0 + sum_{i<n} p_i) v - sum_{i<n} p_i r_i + sum_{i>=n} p_i z_i
 *
 * which is solved for v at the end of the drive; so on the way down, with + r. Most of the memory does not
 * matter there: plays narrower than the way from end to end move on each of them. */
#include "hyst/limited_bank.h"

static hyst_real bank_resting(const hyst_pi *bank, const hyst_real *z, size_t from)
{
    const hyst_real *p = bank->p;
    const size_t count = bank->count;
    hyst_real sum = HYST_REAL(0.0);
    for (size_t i = from; i < count; ++i) {
        sum += p[i] * z[i];
    }
    return sum;
}

/* Gives 1 where v is beyond an end of the drive, to which the plays are taken. side: 1 upwards, -1
 * downwards. */
static int bank_held(const hyst_pi *bank, hyst_real *z, hyst_real side, hyst_real drive,
                     const hyst_bank_end *known, hyst_real v)
{
    const hyst_real *r = bank->r;
    const size_t count = bank->count;
    hyst_real way = side;
    size_t moved = known->moved;
    hyst_real slope = moved > 0u ? known->slope : bank->p0;
    hyst_real rest = drive - known->constant - bank_resting(bank, z, moved);
    hyst_real end = rest / slope;
    if (moved > 0u && way * (end - z[moved - 1u]) < known->least) {
        moved = 0; /* another memory than was expected */
        slope = bank->p0;
        rest = drive - bank_resting(bank, z, moved);
        end = rest / slope;
    }
    if (moved == 0u) { /* from where no play moves the end may lie on either side */
        way = end < z[0] ? -HYST_REAL(1.0) : HYST_REAL(1.0);
    }
    while (moved < count && way * (end - way * r[moved]) > way * z[moved]) {
        rest += bank->p[moved] * (z[moved] + way * r[moved]);
        slope += bank->p[moved];
        end = rest / slope;
        ++moved;
    }
    if (!(side * v > side * end)) {
        return 0;
    }
    for (size_t i = 0; i < moved; ++i) {
        z[i] = end - way * r[i];
    }
    return 1;
}

hyst_real hyst_limited_bank_step(const hyst_pi *bank, const hyst_bank_limits *limits,
                                 hyst_real *state, int *held, hyst_real v)
{
    hyst_real *const last = state + bank->count;
    hyst_real drive;
    if (v > limits->up.from &&
        bank_held(bank, state, HYST_REAL(1.0), limits->high, &limits->up, v) != 0) {
        drive = limits->high;
        *held = 1;
    } else if (v < limits->down.from &&
               bank_held(bank, state, -HYST_REAL(1.0), limits->low, &limits->down, v) != 0) {
        drive = limits->low;
        *held = 1;
    } else {
        drive = hyst_pi_step(bank, state, v);
        if (!(drive >= limits->low && drive <= limits->high)) {
            /* Beyond by rounding; or nothing that is a number, which the last drive answers. */
            const hyst_real not_above = drive > limits->high ? limits->high : *last;
            drive = drive < limits->low ? limits->low : not_above;
            *held = 1;
        }
    }
    *last = drive;
    return drive;
}
