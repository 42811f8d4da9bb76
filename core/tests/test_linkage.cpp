// The core called from C++: links only if the headers declare everything as C.
#include "hyst/hyst.h"

int main() {
    const hyst_real p[] = {1}, r[] = {1};
    const hyst_dead_zone map = {0, p, r};
    const hyst_pi pi = {1, 2, p, r};
    const hyst_stage stages[2] = {{&hyst_dead_zone_kind, &map}, {&hyst_pi_kind, &pi}};
    const hyst_chain chain = {2, stages};
    hyst_guard guard = {5, 0};
    hyst_real state[1] = {4}, y[1] = {3};
    hyst_chain_run(&chain, state, y, y, 1);  // dead zone without terms: 0; play: 4 falls to 0 + 1
    const bool ran = y[0] == 1 && state[0] == 1 && hyst_chain_state_length(&chain) == 1;
    const bool guarded = hyst_guarded_step(&chain, state, &guard, 3) == 1 && guard.fault == 0;
    hyst_real z = 0, u_previous = 0;
    const bool single = hyst_play_step(1, &z, 3) == 2 && hyst_stop_step(1, &z, 3) == 1 &&
                        hyst_pi_step(&pi, state, 3) == 8 &&
                        hyst_dead_zone_step(&map, 3) == 0 &&
                        hyst_direction_dead_zone_step(&map, &u_previous, 3) == 0;
    return ran && guarded && single && hyst_is_finite(0) ? 0 : 1;
}
