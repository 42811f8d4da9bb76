"""Butterflies: numbers by hand, what no record can tell apart, and refusals."""

from __future__ import annotations

import re

import numpy as np
import pytest

import hyst
from hyst import Butterfly, InputError, NotInvertibleError, Play, PrandtlIshlinskii

STRAIN = [[0.0, 0.0, 1.0], [0.0, 0.5, 0.0], [0.25, 0.0, 0.0]]  # z^2 + u z / 2 + u^2 / 4
DRIVE = [0.0, 1.0, 0.5, -1.0, -0.25, 0.75]


def test_strain_by_hand() -> None:
    """A play of radius 1/4: z = 0, 3/4, 3/4, -3/4, -1/2, 1/2."""
    z, u = np.array([0.0, 0.75, 0.75, -0.75, -0.5, 0.5]), np.array(DRIVE)
    np.testing.assert_array_equal(
        Butterfly(Play(0.25), STRAIN)(u), z**2 + 0.5 * u * z + 0.25 * u**2
    )


def test_one_sample_at_a_time_and_a_whole_record_are_the_same_bits() -> None:
    model = Butterfly(PrandtlIshlinskii([1.5, -1.0], [0.25, 0.75]), STRAIN)
    u = np.random.default_rng(4).normal(size=500)
    step = model.stepper()
    assert [step(float(each)) for each in u] == model(u).tolist()


def test_what_overflows_inside_leaves_the_memory() -> None:
    model = Butterfly(Play(0.25) @ hyst.Affine(1e308), STRAIN)
    disturbed, quiet = model.stepper(), model.stepper()
    assert disturbed(1e-308) == quiet(1e-308)
    assert disturbed(10.0) == quiet(1e-308)
    assert disturbed.fault
    assert disturbed(-1e-308) == quiet(-1e-308)


def test_scale_offset_and_linear_part_of_the_state_show_in_no_record() -> None:
    """z = 2 w - u + 3 put into z^2 by hand, w = (z + u - 3) / 2 of plays and an offset."""
    r, u = 0.25, np.random.default_rng(1).normal(size=300)
    plain = Butterfly(Play(r), [[0, 0, 1.0], [0, 0, 0], [0, 0, 0]])
    w = hyst.Affine(1.0, -1.5) @ PrandtlIshlinskii([0.5], [r], p0=0.5)
    other = Butterfly(w, [[9.0, 12.0, 4.0], [-6.0, -4.0, 0.0], [1.0, 0.0, 0.0]])
    # A dozen operations on numbers up to 100.
    np.testing.assert_allclose(other(u), plain(u), rtol=0.0, atol=1e-13)


def test_parameters_have_the_powers_in_their_names() -> None:
    model = Butterfly(Play(0.25), STRAIN)
    names = model.parameters().names
    assert names == ("hysteresis.r", "c[0,0]", "c[0,1]", "c[0,2]", "c[1,0]", "c[1,1]", "c[2,0]")
    assert dict(zip(names, model.parameters().values, strict=True))["c[1,1]"] == 0.5
    assert model.with_parameters(model.parameters().values) == model


def test_a_hysteresis_may_be_any_operator() -> None:
    """Friction that has slid to its Coulomb force, 2, both ways: z = +-2 to rounding."""
    model = Butterfly(hyst.Dahl(1.0, 2.0), [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    y = model([300.0, -300.0])
    np.testing.assert_allclose(y, [4.0 + 600.0, 4.0 + 600.0], rtol=1e-12)
    assert not model.traits().return_point_memory
    assert Butterfly(Play(0.25), STRAIN).traits().return_point_memory


def test_an_exact_inverse_is_refused_with_the_turn() -> None:
    """z^2 of a play of radius 1/4 is least where z of the rising input passes 0: at 1/4."""
    model = Butterfly(Play(0.25), [[0, 0, 1.0], [0, 0, 0], [0, 0, 0]])
    with pytest.raises(NotInvertibleError) as caught:
        model.inverse()
    told = re.search(r"rising input passes (\S+),", str(caught.value))
    assert told is not None
    amplitude = float(re.findall(r"between -(\S+) and", str(caught.value))[0])
    # The strokes it looks at have 64 samples.
    assert float(told[1]) == pytest.approx(0.25, abs=2.0 * amplitude / 64.0)
    assert "'trajectory'" in str(caught.value)


def test_an_inverse_of_what_nothing_says_rises_is_refused_too() -> None:
    with pytest.raises(NotInvertibleError, match="nothing says that it rises"):
        Butterfly(Play(0.25), [[0.0, 1.0], [1.0, 0.0]]).inverse()


@pytest.mark.parametrize(
    ("hysteresis", "c", "what"),
    [
        (3.0, STRAIN, "hysteresis is of type float; give an operator"),
        (Play(1.0), [[0.0, 1.0]], r"c has shape \(1, 2\)"),
        (Play(1.0), [1.0, 2.0], r"c has shape \(2,\)"),
        (Play(1.0), np.zeros((8, 8)), "c is of degree 7; give 1 to 7 rows"),
        (Play(1.0), np.zeros((0, 0)), "c is of degree -1"),
        (Play(1.0), [[0.0, np.nan], [1.0, 0.0]], "c"),
        (Play(1.0), [[0.0, 1.0], [1.0, 2.0]], r"c\[1,1\] is 2, beyond the degree 1; .* 3 rows"),
    ],
)
def test_what_makes_no_butterfly_is_refused(hysteresis: object, c: object, what: str) -> None:
    with pytest.raises(InputError, match=what):
        Butterfly(hysteresis, c)  # type: ignore[arg-type]
