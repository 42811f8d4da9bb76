/* Sub-steps along a branch: the method of order 8 of Cooper and Verner. */
#include "hyst/branch.h"

#include "hyst/finite.h"

/* Widths that a count holds; so far from a turn, no sample lies between two nodes to speak of. */
#define BRANCH_COUNTED HYST_REAL(2147483648.0)

int hyst_branch_turns(hyst_real began, hyst_real last, hyst_real input)
{
    return (input > last && last < began) || (input < last && last > began);
}

hyst_real hyst_branch_advance(const hyst_branch_equation *of, hyst_real u, hyst_real z,
                              hyst_real sign, hyst_real h)
{
    const hyst_real du = sign * h;
    const hyst_real k1 = of->slope(of->model, u, z, sign);
    const hyst_real k2 = of->slope(
        of->model, u + HYST_REAL(0.5) * du, z + du * (HYST_REAL(0.5) * k1), sign);
    const hyst_real k3 = of->slope(
        of->model, u + HYST_REAL(0.5) * du,
        z + du * (HYST_REAL(0.25) * k1 + HYST_REAL(0.25) * k2),
        sign);
    const hyst_real k4 = of->slope(
        of->model, u + HYST_REAL(0.8273268353539885) * du,
        z + du * (HYST_REAL(0.14285714285714285) * k1 - HYST_REAL(0.2117115008659951) * k2
                  + HYST_REAL(0.8961811933628409) * k3),
        sign);
    const hyst_real k5 = of->slope(
        of->model, u + HYST_REAL(0.8273268353539885) * du,
        z + du * (HYST_REAL(0.18550685351137905) * k1 + HYST_REAL(0.5766714726956089) * k3
                  + HYST_REAL(0.06514850914700064) * k4),
        sign);
    const hyst_real k6 = of->slope(
        of->model, u + HYST_REAL(0.5) * du,
        z + du * (HYST_REAL(0.19963699364491333) * k1 + HYST_REAL(0.3772937693043289) * k3
                  - HYST_REAL(0.46345538964060623) * k4 + HYST_REAL(0.386524626691364) * k5),
        sign);
    const hyst_real k7 = of->slope(
        of->model, u + HYST_REAL(0.17267316464601143) * du,
        z + du * (HYST_REAL(0.1289862929772419) * k1 - HYST_REAL(0.03302551131448482) * k3
                  - HYST_REAL(0.3497052863177422) * k4 + HYST_REAL(0.32851721314173715) * k5
                  + HYST_REAL(0.09790045615925942) * k6),
        sign);
    const hyst_real k8 = of->slope(
        of->model, u + HYST_REAL(0.17267316464601143) * du,
        z + du * (HYST_REAL(0.07142857142857142) * k1 + HYST_REAL(0.0020021659931149204) * k5
                  - HYST_REAL(0.011868683886786031) * k6 + HYST_REAL(0.1111111111111111) * k7),
        sign);
    const hyst_real k9 = of->slope(
        of->model, u + HYST_REAL(0.5) * du,
        z + du * (HYST_REAL(0.03125) * k1 - HYST_REAL(0.009086961100820556) * k5
                  + HYST_REAL(0.1527777777777778) * k6 - HYST_REAL(0.6325461606959097) * k7
                  + HYST_REAL(0.9576053440189525) * k8),
        sign);
    const hyst_real k10 = of->slope(
        of->model, u + HYST_REAL(0.8273268353539885) * du,
        z + du * (HYST_REAL(0.07142857142857142) * k1 + HYST_REAL(0.1111111111111111) * k5
                  - HYST_REAL(0.6379313501852646) * k6 + HYST_REAL(2.031083139166862) * k7
                  - HYST_REAL(1.8108630829377543) * k8 + HYST_REAL(1.0624984467704635) * k9),
        sign);
    const hyst_real k11 = of->slope(
        of->model, u + du,
        z + du * (-HYST_REAL(0.5512205630727289) * k5 + HYST_REAL(2.451380432416967) * k6
                  - HYST_REAL(7.164951553231382) * k7 + HYST_REAL(7.553840442120271) * k8
                  - HYST_REAL(2.2291582101947447) * k9 + HYST_REAL(0.9401094519616178) * k10),
        sign);
    return z + du * (HYST_REAL(0.05) * k1 + HYST_REAL(0.2722222222222222) * k8
                     + HYST_REAL(0.35555555555555557) * k9 + HYST_REAL(0.2722222222222222) * k10
                     + HYST_REAL(0.05) * k11);
}

/* The last node at or before a way of so many widths. */
static hyst_real branch_node(hyst_real widths)
{
    if (widths < BRANCH_COUNTED) {
        return (hyst_real)(size_t)widths;
    }
    return widths;
}

hyst_real hyst_branch_step(const hyst_branch_equation *of, hyst_real *state, hyst_real u)
{
    hyst_real u_turn = state[HYST_BRANCH_U_TURN];
    hyst_real z_turn = state[HYST_BRANCH_Z_TURN];
    hyst_real node = state[HYST_BRANCH_NODE];
    hyst_real z_node = state[HYST_BRANCH_Z_NODE];
    if (hyst_branch_turns(u_turn, state[HYST_BRANCH_U], u) != 0) {
        u_turn = state[HYST_BRANCH_U];
        z_turn = state[HYST_BRANCH_Z];
        node = HYST_REAL(0.0);
        z_node = z_turn;
    }
    const hyst_real sign = u < u_turn ? HYST_REAL(-1.0) : HYST_REAL(1.0);
    const hyst_real way = sign * (u - u_turn);
    const hyst_real widths = way / of->width;
    if (hyst_is_finite(widths) == 0) {
        return widths;
    }
    const hyst_real last = branch_node(widths);
    /* What lies further back than the most nodes is forgotten. */
    const hyst_real most = (hyst_real)HYST_BRANCH_MOST;
    const hyst_real passes = last - node;
    const size_t count = passes < most ? (size_t)passes : HYST_BRANCH_MOST;
    for (size_t left = count; left > 0u; --left) {
        const hyst_real passed = (last - (hyst_real)left) * of->width;
        z_node = hyst_branch_advance(of, u_turn + sign * passed, z_node, sign, of->width);
    }
    const hyst_real from = last * of->width;
    const hyst_real z = hyst_branch_advance(of, u_turn + sign * from, z_node, sign, way - from);
    if (hyst_is_finite(z) == 0) {
        return z;
    }
    state[HYST_BRANCH_U] = u;
    state[HYST_BRANCH_Z] = z;
    state[HYST_BRANCH_U_TURN] = u_turn;
    state[HYST_BRANCH_Z_TURN] = z_turn;
    state[HYST_BRANCH_NODE] = last;
    state[HYST_BRANCH_Z_NODE] = z_node;
    return z;
}
