"""S4: the inverse of the rate-independent part (eqs. 14-16) and the identified example."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from hyst import DeadZone, ModifiedPrandtlIshlinskii, PrandtlIshlinskii

# Sec. III-F; alpha_i = zeta i with zeta = 3. Eq. 23 prints zeta^i, but eqs. 21 and 25 need zeta i.
A0, A = 0.5, [0.3667, 0.2690, 0.1973, 0.1447]
ALPHA = [3.0, 6.0, 9.0, 12.0]

# The identified actuator: n = 3, zeta = 9.715.
ZETA, A0_IDENTIFIED, A_IDENTIFIED = 9.715, 0.7124, [0.2906, 0.0461, 0.1512]
B_IDENTIFIED = [1.40371, -0.40670, -0.04381, -0.12007]
S_IDENTIFIED = [6.92097, 16.66511, 26.85712]
# As printed; they do not follow from the printed parameters by any of eqs. 14-16.
B_PRINTED = [1.3892, -0.3961, -0.038, -0.1187]
S_PRINTED = [7.0293, 16.8823, 27.1395]


def test_inverse_of_the_example_of_section_3f() -> None:
    inverse = PrandtlIshlinskii(A, ALPHA, A0).inverse()
    c = [Fraction("0.5")]
    for weight in ("0.3667", "0.2690", "0.1973", "0.1447"):
        c.append(c[-1] + Fraction(weight))
    # Eq. 15: b_0 = 1/a_0 and b_i = 1/c_i - 1/c_{i-1}; eq. 14: s_{i+1} - s_i = c_i (r_{i+1} - r_i).
    b = [float(1 / c[i] - 1 / c[i - 1]) for i in range(1, 5)]
    s = np.cumsum([float(3 * each) for each in c[:4]])
    assert inverse.p0 == 2.0
    # A few roundings each; eq. 15 is a difference of exact fractions here.
    assert inverse.p == pytest.approx(b, rel=1e-14)
    assert inverse.r == pytest.approx(s, rel=1e-14)


def test_initial_memory_of_the_inverse() -> None:
    """Eq. 16, with y_1 = a_0 x_1 as in eq. 18 (a_1 x_1 is a misprint).

    x_i and y_i are what the plays of model and inverse are away from their inputs.
    """
    z0 = [1.5, -0.5, 2.0, 1.0]  # neighbours no further apart than their thresholds, 3
    model = PrandtlIshlinskii(A, ALPHA, A0, z0)
    inverse = model.inverse()
    u0 = 0.75  # inside all plays: nothing moves
    v0 = model([u0])[0]
    x, y = u0 - np.array(z0), v0 - inverse.z0
    assert y[0] == pytest.approx(A0 * x[0], rel=1e-13)
    c = A0 + np.cumsum([0.0, *A])
    assert np.diff(y) == pytest.approx(c[1:4] * np.diff(x), rel=1e-13)
    assert inverse([v0])[0] == pytest.approx(u0, rel=1e-14)


def test_inverse_of_the_identified_example() -> None:
    inverse = PrandtlIshlinskii(A_IDENTIFIED, [ZETA, 2 * ZETA, 3 * ZETA], A0_IDENTIFIED).inverse()
    # Half a unit of the last digit given.
    assert inverse.p0 == pytest.approx(B_IDENTIFIED[0], abs=0.5e-5)
    assert inverse.p == pytest.approx(B_IDENTIFIED[1:], abs=0.5e-5)
    assert inverse.r == pytest.approx(S_IDENTIFIED, abs=0.5e-5)


def test_the_printed_inverse_belongs_to_other_parameters() -> None:
    """b_0 = 1/a_0 alone shows it: the printed 1.3892 is 1/0.7198, and a_0 = 0.7124.

    So the printed inverse leaves an error in the paper's own compensation.
    """
    model = PrandtlIshlinskii(A_IDENTIFIED, [ZETA, 2 * ZETA, 3 * ZETA], A0_IDENTIFIED)
    printed = PrandtlIshlinskii(B_PRINTED[1:], S_PRINTED, B_PRINTED[0])
    assert printed.inverse().p0 == pytest.approx(0.7198, abs=1e-4)
    assert S_PRINTED[0] / ZETA == pytest.approx(0.72355, abs=1e-5)  # should be a_0, too
    wanted = 40.0 * np.sin(np.linspace(0.0, 4.0 * np.pi, 2001))
    with_printed = np.abs(model(printed(wanted)) - wanted).max()
    exact = np.abs(model(model.inverse()(wanted)) - wanted).max()
    # b_0 is 1 % off over the first threshold's 7, and some of it comes back.
    assert with_printed > 0.1
    # Slopes from 0.71 to 1.2: no more than a few roundings of 40.
    assert exact <= 20.0 * np.finfo(float).eps * 40.0


def test_the_modified_model_is_inverted_map_first() -> None:
    """Eqs. 27-28: Lambda o Psi has the inverse Psi^-1 o Lambda^-1 (eq. 31 says Gamma)."""
    plays = PrandtlIshlinskii(A, ALPHA, A0)
    output_map = DeadZone([0.9, 0.2, -0.3, 0.15], [0.0, 4.0, 11.0, -6.0])
    model = ModifiedPrandtlIshlinskii(plays, output_map)
    t = np.linspace(0.0, 1.0, 1500)
    u = 22.0 * np.sin(2.0 * np.pi * t) + 25.0 * np.sin(6.0 * np.pi * t)
    assert (model(u) == output_map(plays(u))).all()
    inverse = model.inverse()
    assert (inverse(model(u)) == plays.inverse()(output_map.inverse()(model(u)))).all()
    # Slopes 0.5 to 1.48 of the plays, 0.8 to 1.1 of the map: rounding grows less than tenfold.
    assert np.abs(inverse(model(u)) - u).max() <= 100.0 * np.finfo(float).eps * 37.0
