"""S0: the numerical example of sec. V-C, a generalized model that has no inverse."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import DeadZone, GeneralizedPrandtlIshlinskii, NotInvertibleError, PrandtlIshlinskii
from reference.numpy_operators import dead_zone, dead_zone_by_direction, play

R = [0.0769, 0.1538, 0.2307, 0.3076, 0.3845, 0.4614, 0.5383, 0.6152]
P = [3.6590, 2.8098, 2.1577, 1.6569, 1.2724, 0.9771, 0.7503, 0.5762]
ETA = [0.8 * i for i in range(-8, 9)]
# g_12 is printed as "-0. -0.2176".
G = [-0.198, -0.057, -0.1669, -0.13, -0.15, -0.037, 0.02, 0.23, 0.0]
G += [-0.249, -0.004, -0.2176, -0.0734, 0.0568, -0.058, -0.13, -2.479]


def test_numbers_agree_with_the_laws_behind_them() -> None:
    """A slip of the pen in a list of 50 numbers would go unnoticed otherwise."""
    # r_i = 0.0769 i, and p falls by the factor exp(-0.26409) from one to the next.
    assert pytest.approx(0.0769 * np.arange(1, 9), abs=1e-12) == R
    assert np.diff(np.log(P)) == pytest.approx(np.full(7, -0.26409), abs=1e-4)
    assert ETA[0] == -6.4
    assert ETA[8] == 0.0
    assert len(G) == len(ETA) == 17


@pytest.mark.parametrize("variant", ["two-sided", "by-direction"])
def test_the_chain_of_the_paper(variant: str) -> None:
    """Eqs. 1-7 term by term, one sample at a time."""
    front = DeadZone(G, ETA, variant)
    plays = PrandtlIshlinskii(P, R)
    t = 0.01 * np.arange(400)
    u = 4.0 * np.sin(5.0 * t) + 3.5 * np.sin(13.0 * t)
    z, before = [], 0.0
    for value in u.tolist():
        terms = [
            dead_zone(value, eta)[0]
            if variant == "two-sided"
            else dead_zone_by_direction(before, value, eta)[0]
            for eta in ETA
        ]
        z.append(sum(g * term for g, term in zip(G, terms, strict=True)))
        before = value
    v = sum(p * play(np.array(z), r, 0.0)[0] for p, r in zip(P, R, strict=True))
    # 17 and 8 terms; |u| <= 7.5, sum |g| = 4.26, sum p = 13.86.
    tolerance = 25.0 * np.finfo(float).eps * 7.5 * 4.26 * 13.86
    assert np.abs((plays @ front)(u) - v).max() <= tolerance
    if variant == "two-sided":
        # The printed form remembers the direction, so it cannot be the envelope of a named model.
        assert GeneralizedPrandtlIshlinskii(front, plays)(u).tolist() == (plays @ front)(u).tolist()


def test_the_map_is_not_monotone_and_has_no_inverse() -> None:
    front = DeadZone(G, ETA)
    assert not front.traits().monotone
    # g_9 = 0 at threshold 0: the map is 0 from -0.8 to 0.8.
    assert not front(np.linspace(-0.8, 0.8, 9)).any()
    with pytest.raises(NotInvertibleError, match="flat around 0"):
        front.inverse()


def test_the_plays_have_no_inverse() -> None:
    # Eq. 11 has no linear part.
    with pytest.raises(NotInvertibleError, match=r"p0 is 0: .* give p0 > 0"):
        PrandtlIshlinskii(P, R).inverse()


def test_the_example_as_a_model_refuses() -> None:
    model = GeneralizedPrandtlIshlinskii(DeadZone(G, ETA), PrandtlIshlinskii(P, R, p0=1.0))
    assert not model.traits().invertible
    with pytest.raises(NotInvertibleError, match="flat around 0"):
        model.inverse()
