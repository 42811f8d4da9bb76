"""S1: the inverse of the Prandtl-Ishlinskii model (sec. 5.2) and of the envelope (sec. 5.3).

Where the paper prints other digits, the printed value is kept here beside the computed one, with
the reason.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from hyst import (
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    PrandtlIshlinskii,
)

P0 = 0.1
P = [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7]
R = [4.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0, 40.0]

# Eqs. 7-8 from the printed p and r, to the digits that follow from them.
S = [0.4, 0.985, 1.846, 3.118, 5.004, 7.807, 11.977, 18.186, 27.44, 41.09]
S_HALF_A_DIGIT = [0.5e-3] * 8 + [0.5e-2] * 2
G = [-3.160, -2.193, -1.503, -1.023, -0.693, -0.468, -0.315, -0.212, -0.139, -0.097]
# As printed.
S_PRINTED = [0.4, 0.985, 1.8459, 3.1186, 5.00, 7.8085, 11.9784, 18.1875, 27.4386, 41.2279]
G_PRINTED = [-3.16, -2.1918, -1.5030, -1.0231, -0.6930, -0.4678, -0.315, -0.2118, -0.1423, -0.0955]


def model() -> PrandtlIshlinskii:
    return PrandtlIshlinskii(P, R, P0)


def test_thresholds_and_weights_of_the_inverse() -> None:
    inverse = model().inverse()
    assert inverse.p0 == 10.0
    assert (np.abs(inverse.r - S) <= S_HALF_A_DIGIT).all()
    assert np.abs(inverse.p - G).max() <= 0.5e-3  # half a unit of the last digit


def test_against_exact_fractions() -> None:
    """Eqs. 7 and 8 with the printed decimals taken as exact fractions."""
    exact = [Fraction(text) for text in map(str, [P0, *P])]
    inverse = model().inverse()
    s = total = Fraction(0)
    for j, weight in enumerate(exact[1:], start=1):
        before = sum(exact[:j], Fraction(0))
        total = before + weight
        s += before * 4
        # A few roundings of sums of up to 11 numbers.
        assert inverse.r[j - 1] == pytest.approx(float(s), rel=1e-14)
        assert inverse.p[j - 1] == pytest.approx(float(-weight / (total * before)), rel=1e-14)


def test_the_printed_inverse_is_that_of_unrounded_weights() -> None:
    """All printed values but the last two weights and the last threshold agree to 2 in 1000.

    Those belong to weights that the paper printed as 1.1 and 1.7 (two digits): solving eqs. 7-8
    for the weights that do give the printed inverse leads to about 1.134 and 1.692, which round to
    them and continue the ratio of 1.49 of the others. Every hyst number above follows from the
    printed weights.
    """
    inverse = model().inverse()
    away_s = np.abs(inverse.r / S_PRINTED - 1.0)
    away_g = np.abs(inverse.p / G_PRINTED - 1.0)
    assert away_s[:-1].max() < 1.0e-3
    assert away_g[:-2].max() < 1.5e-3
    assert away_s[-1] == pytest.approx(0.0033, abs=1e-4)
    assert away_g[-2:] == pytest.approx([0.021, 0.020], abs=2e-3)

    # c_8 from p_1 .. p_8; eq. 7 for s_10 - s_9 gives c_9, eq. 8 for g_10 gives c_10.
    c8 = P0 + sum(P[:8])
    c9 = (S_PRINTED[9] - S_PRINTED[8]) / 4.0
    c10 = 1.0 / (1.0 / c9 + G_PRINTED[9])
    assert c9 - c8 == pytest.approx(1.134, abs=1e-3)
    assert c10 - c9 == pytest.approx(1.692, abs=1e-3)


def test_the_model_and_its_inverse_cancel() -> None:
    """The reference input of S1 figs. 7 and 10."""
    t = np.linspace(0.0, 2.0, 2001)
    r = 18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t)
    # Slopes from 0.1 to 5.1: rounding grows by no more than their ratio of 51, and 11 terms.
    tolerance = 50.0 * 11.0 * np.finfo(float).eps * np.abs(r).max()
    assert np.abs(model().inverse()(model()(r)) - r).max() <= tolerance
    assert np.abs(model()(model().inverse()(r)) - r).max() <= tolerance


XI = [0.65, 0.2, 0.3, 0.4]
RHO = [0.0, 7.56, 12.0, 17.69]
PSI = [4.914, 8.688, 15.2315]
EPSILON = [1.5385, -0.3620, -0.3069, -0.2244]
PSI_1_PRINTED, EPSILON_1_PRINTED = 4.94, -0.361  # 0.65 7.56 = 4.914; -0.2/(0.85 0.65) = -0.36199


def test_thresholds_and_weights_of_the_inverse_envelope() -> None:
    """Eqs. 52-55; one-sided first, as printed: a map for inputs >= 0."""
    inverse = DeadZone(XI, RHO).inverse()
    assert inverse.thresholds[0] == 0.0
    assert inverse.thresholds[1] == pytest.approx(0.65 * 7.56, rel=1e-15)
    assert np.abs(inverse.thresholds[1:] - PSI).max() <= 0.5e-4
    assert np.abs(inverse.weights - EPSILON).max() <= 0.5e-4
    # The two printed values that are no rounding of what eqs. 53 and 55 give.
    assert abs(inverse.thresholds[1] - PSI_1_PRINTED) == pytest.approx(0.026, abs=1e-9)
    assert abs(inverse.weights[1] - EPSILON_1_PRINTED) == pytest.approx(0.00099, abs=1e-5)


def test_the_odd_envelope_has_the_odd_inverse() -> None:
    """Sec. 2.1 asks for an odd envelope, eqs. 49-50 alone give 0.65 v below 0."""
    envelope = DeadZone.odd(XI, RHO)
    inverse = envelope.inverse()
    right, left = inverse.thresholds > 0.0, inverse.thresholds < 0.0
    assert (inverse.thresholds[right] == -inverse.thresholds[left]).all()
    assert (inverse.weights[right] == inverse.weights[left]).all()
    assert np.abs(inverse.thresholds[right] - PSI).max() <= 0.5e-4
    v = np.linspace(-30.0, 30.0, 601)
    assert (envelope(-v) == -envelope(v)).all()
    # Slopes 0.65 to 1.55, four terms a side.
    assert np.abs(inverse(envelope(v)) - v).max() <= 20.0 * np.finfo(float).eps * 30.0


def test_the_generalized_model_of_section_5_3() -> None:
    hysteresis = GeneralizedPrandtlIshlinskii(DeadZone.odd(XI, RHO), model())
    inverse = hysteresis.inverse()
    # Eq. 5: first the inverse plays, then the inverse envelope.
    assert isinstance(inverse, ModifiedPrandtlIshlinskii)
    assert inverse.parts == (model().inverse(), DeadZone.odd(XI, RHO).inverse())
    t = np.linspace(0.0, 2.0, 2001)
    r = 18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t)
    tolerance = 50.0 * 2.4 * 11.0 * np.finfo(float).eps * np.abs(r).max()
    assert np.abs(inverse(hysteresis(r)) - r).max() <= tolerance
    assert np.abs(hysteresis(inverse(r)) - r).max() <= tolerance
