#include "check.h"

/* Kalman update of P = [[4 2] [2 2]] by psi = (1, 1), noise 2, by hand: P psi = (6, 4), a = 12,
 * P - (6 4)'(6 4)/12 = [[1 0] [0 2/3]]. P = U D U' with u = 1, d = (2, 2). */
static void follows_hand_calculation(void)
{
    hyst_real u[] = {R(1.0)};
    hyst_real d[] = {R(2.0), R(2.0)};
    const hyst_real psi[] = {R(1.0), R(1.0)};
    hyst_real gain[2];
    hyst_real f[2];
    CHECK_EQUAL(hyst_ud_times(2, u, d, psi, gain), R(10.0));
    CHECK_EQUAL(gain[0], R(6.0));
    CHECK_EQUAL(gain[1], R(4.0));
    CHECK_EQUAL(hyst_ud_update(2, u, d, psi, R(2.0), gain, f), R(12.0));
    CHECK_EQUAL(gain[0], R(6.0));
    CHECK_EQUAL(gain[1], R(4.0));
    CHECK_NEAR((double)u[0], 0.0, 4.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)d[0], 1.0, 4.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)d[1], 2.0 / 3.0, 4.0 * (double)REAL_EPSILON);
}

/* S P S with S = diag(2, 4) has the variances 4 P_11 and 16 P_22 and the covariance 8 P_12. */
static void scales_on_both_sides(void)
{
    hyst_real u[] = {R(1.0)};
    hyst_real d[] = {R(2.0), R(2.0)};
    const hyst_real s[] = {R(2.0), R(4.0)};
    hyst_real variance[2];
    hyst_ud_scale(2, u, d, s);
    hyst_ud_variances(2, u, d, variance);
    CHECK_EQUAL(variance[0], R(16.0));
    CHECK_EQUAL(variance[1], R(32.0));
    CHECK_EQUAL(u[0] * d[1], R(16.0));
}

/* After many updates the variances are those of batch least squares, whose normal matrix is
 * inverted here by cofactors: P = (I / 100 + sum psi psi')^-1. */
static void agrees_with_batch_least_squares(void)
{
    enum { samples = 200 };
    static hyst_real noise[3 * samples];
    hyst_real u[3] = {R(0.0), R(0.0), R(0.0)};
    hyst_real d[3] = {R(100.0), R(100.0), R(100.0)};
    double n[3][3] = {{0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}, {0.0, 0.0, 0.01}};
    hyst_real gain[3];
    hyst_real f[3];
    hyst_real variance[3];
    fill_with_noise(noise, COUNT(noise), R(1.0));
    for (size_t k = 0; k < samples; ++k) {
        const hyst_real *psi = noise + 3 * k;
        hyst_ud_update(3, u, d, psi, R(1.0), gain, f);
        for (size_t i = 0; i < 3; ++i) {
            for (size_t j = 0; j < 3; ++j) {
                n[i][j] += (double)psi[i] * (double)psi[j];
            }
        }
    }
    hyst_ud_variances(3, u, d, variance);
    const double minor0 = n[1][1] * n[2][2] - n[1][2] * n[1][2];
    const double minor1 = n[0][0] * n[2][2] - n[0][2] * n[0][2];
    const double minor2 = n[0][0] * n[1][1] - n[0][1] * n[0][1];
    const double determinant = n[0][0] * minor0 - n[0][1] * (n[0][1] * n[2][2] - n[1][2] * n[0][2]) +
                               n[0][2] * (n[0][1] * n[1][2] - n[1][1] * n[0][2]);
    /* 200 updates, each rounding a few times; the variances are about 0.015. */
    const double tolerance = 500.0 * (double)REAL_EPSILON * 0.015;
    CHECK_NEAR((double)variance[0], minor0 / determinant, tolerance);
    CHECK_NEAR((double)variance[1], minor1 / determinant, tolerance);
    CHECK_NEAR((double)variance[2], minor2 / determinant, tolerance);
}

/* A parameter without variance is not moved and gets none. */
static void a_held_parameter_stays(void)
{
    hyst_real u[] = {R(0.0)};
    hyst_real d[] = {R(0.0), R(1.0)};
    const hyst_real psi[] = {R(3.0), R(1.0)};
    hyst_real gain[2];
    hyst_real f[2];
    CHECK_EQUAL(hyst_ud_update(2, u, d, psi, R(1.0), gain, f), R(2.0));
    CHECK_EQUAL(gain[0], R(0.0));
    CHECK_EQUAL(d[0], R(0.0));
    CHECK_EQUAL(d[1], R(0.5));
}

int main(void)
{
    follows_hand_calculation();
    scales_on_both_sides();
    agrees_with_batch_least_squares();
    a_held_parameter_stays();
    return check_result();
}
