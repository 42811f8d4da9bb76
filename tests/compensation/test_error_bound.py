"""The bound of S1 eq. 16: never violated, attained by plays, exact in its integral."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.compensation import error_bound
from hyst.errors import InputError, NotInvertibleError
from hyst.models import GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii
from hyst.operators import Operator
from reference.random_plays import random_inverse, random_model, rich_reference

# S1 sec. 5.2.
R = np.arange(4.0, 41.0, 4.0)
P = [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7]
PAPER = hyst.PrandtlIshlinskii(P, R, 0.1)

# Rounding of outputs and bounds of order 1 to 1e3, through at most two maps and eight plays.
ROUNDING = 1e-12


@pytest.mark.parametrize("seed", range(4))
def test_it_is_never_violated(seed: int) -> None:
    """4000 pairs: PI, GPI and MPI with 0 to 8 plays, unrelated inverses; the benchmark has 10^4."""
    rng = np.random.default_rng(seed)
    attained = 0
    for _ in range(1000):
        model = random_model(rng)
        approximate = random_inverse(rng, model)
        y_max = float(rng.uniform(0.5, 20.0))
        limit = error_bound(model, approximate, y_max)
        y_ref = np.concatenate([limit.worst_reference, rich_reference(rng, y_max)])
        u_hat = approximate(y_ref)
        error = np.abs(model.inverse()(y_ref) - u_hat).max()
        scale = y_max + np.abs(u_hat).max()
        assert limit.sharp_bound <= limit.bound
        assert limit.reached - ROUNDING * scale <= error <= limit.sharp_bound + ROUNDING * scale
        output = np.abs(model(u_hat) - y_ref).max()
        assert output <= limit.output_bound + ROUNDING * max(scale, limit.output_bound)
        attained += error > 0.999 * limit.bound
    # A bound that is never near the error would pass too; about a third are reached (the PI ones).
    assert attained > 250


@pytest.mark.parametrize("seed", range(20))
def test_of_plays_alone_it_is_the_least_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    model = random_model(rng, "pi")
    approximate = random_inverse(rng, model)
    limit = error_bound(model, approximate, 7.0)
    y_ref = limit.worst_reference
    assert np.abs(y_ref).max() <= 7.0
    error = np.abs(model.inverse()(y_ref) - approximate(y_ref))[-1]
    # Rounding of the outputs, of order 10.
    assert error == pytest.approx(limit.bound, rel=1e-12, abs=1e-12)


def test_the_integral_by_hand() -> None:
    # phi = 1, then 1/2 from s = 1; phi_hat = 0.9, then 0.7 from 0.5; on [0, 3]:
    # 0.5 * 0.1 + 0.5 * 0.3 + 2 * 0.2 = 0.6.
    model = hyst.PrandtlIshlinskii([1.0], [1.0], 1.0)
    approximate = hyst.PrandtlIshlinskii([-0.2], [0.5], 0.9)
    limit = error_bound(model, approximate, 3.0)
    assert limit.bound == pytest.approx(0.6, rel=1e-14)
    assert (limit.envelope_error, limit.lipschitz, limit.map_error) == (0.0, 1.0, 0.0)


def test_the_envelope_by_hand() -> None:
    # Envelope 2x up to x = 1, then slope 1: the inverse has slope 1/2, then 1 from 2 on.
    # Approximate envelope inverse 0.5 x, differing by 0.5 (x - 2) beyond 2; plays exact.
    model = GeneralizedPrandtlIshlinskii(
        hyst.DeadZone.odd([2.0, -1.0], [0.0, 1.0]), hyst.PrandtlIshlinskii([], [], 1.0)
    )
    approximate = hyst.Affine(0.5) @ hyst.PrandtlIshlinskii([], [], 1.0)
    assert error_bound(model, approximate, 2.0).bound == 0.0
    limit = error_bound(model, approximate, 5.0)
    assert limit.envelope_error == pytest.approx(1.5, rel=1e-14)
    # Output: envelope(0.5 * 5) - 5 = 3.5 - 5.
    assert limit.output_bound == pytest.approx(1.5, rel=1e-14)


def test_the_slope_of_the_envelope_is_that_of_the_range_used() -> None:
    steep_far_out = hyst.DeadZone.odd([1.0, -0.9], [0.0, 10.0])
    model = GeneralizedPrandtlIshlinskii(steep_far_out, hyst.PrandtlIshlinskii([0.5], [1.0], 0.5))
    approximate = steep_far_out.inverse() @ hyst.PrandtlIshlinskii([-0.9], [0.6], 1.9)
    assert error_bound(model, approximate, 4.0).lipschitz == pytest.approx(1.0)
    # Beyond 10 the envelope has slope 0.1, its inverse 10.
    assert error_bound(model, approximate, 40.0).lipschitz == pytest.approx(10.0)


def test_the_supremum_of_w_is_one_of_its_modulus() -> None:
    """As printed, ``sup w``, eq. 15 would say 0 for a w that stays below 0."""
    w = np.array([-1.0, -3.0])
    model = hyst.PrandtlIshlinskii([1.0], [1.0], 1.0)
    error = np.abs(model.inverse()(w) - w).max()
    assert error == pytest.approx(error_bound(model, hyst.Affine(1.0), 3.0).bound)


def test_the_bound_is_one_of_the_command_and_not_of_the_output() -> None:
    """S1 eq. 17 takes it for the output error; that may be far larger."""
    limit = error_bound(PAPER, hyst.Affine(0.95) @ PAPER.inverse(), 43.0)
    y_ref = 43.0 * np.sin(np.linspace(0.0, 20.0, 4000))
    output = np.abs(PAPER(0.95 * PAPER.inverse()(y_ref)) - y_ref).max()
    assert limit.bound < output <= limit.output_bound


def test_a_scaled_inverse_of_the_paper() -> None:
    # 0.7 G^-1: 0.3 times the largest command, which is G^-1 loading from 0 to 43 (S1 eqs. 7-8 with
    # the thresholds and weights computed from the printed ones).
    exact = PAPER.inverse()
    loading = exact.p0 * 43.0 + float(np.maximum(43.0 - exact.r, 0.0) @ exact.p)
    limit = error_bound(PAPER, hyst.Affine(0.7) @ exact, 43.0)
    assert limit.bound == pytest.approx(0.3 * loading, rel=1e-12)
    assert limit.reached == pytest.approx(limit.bound, rel=1e-12)


@pytest.mark.parametrize("kind", ["pi", "gpi", "mpi"])
def test_the_exact_inverse_has_none(kind: str) -> None:
    model = random_model(np.random.default_rng(3), kind)
    limit = error_bound(model, model.inverse(), 10.0)
    # Thresholds and slopes of inverse and model, of order 10, to rounding.
    assert limit.bound == pytest.approx(0.0, abs=1e-12)
    assert limit.output_bound == pytest.approx(0.0, abs=1e-11)


def test_gains_on_either_side_are_the_same_bound() -> None:
    inverse = PAPER.inverse()
    after = error_bound(PAPER, hyst.Affine(0.5) @ inverse, 20.0)
    written_out = hyst.PrandtlIshlinskii(0.5 * inverse.p, inverse.r, 0.5 * inverse.p0)
    assert after.bound == pytest.approx(error_bound(PAPER, written_out, 20.0).bound, rel=1e-14)
    before = error_bound(PAPER, inverse @ hyst.Affine(-0.5), 20.0)
    halved = hyst.PrandtlIshlinskii(-0.5 * inverse.p, 2.0 * inverse.r, -0.5 * inverse.p0)
    assert before.bound == pytest.approx(error_bound(PAPER, halved, 20.0).bound, rel=1e-14)


def test_summary_and_dictionary() -> None:
    limit = error_bound(PAPER, hyst.Affine(0.7) @ PAPER.inverse(), 43.0)
    assert "eq. 16" in limit.summary()
    assert "12.11" in limit.summary()
    assert limit.to_dict()["y_max"] == 43.0


MEMORY = hyst.PrandtlIshlinskii([1.0], [1.0], 1.0, z0=[0.5])
FLAT = GeneralizedPrandtlIshlinskii(hyst.DeadZone([1.0], [1.0]), PAPER)


@pytest.mark.parametrize(
    ("model", "approximate", "y_max", "error", "message"),
    [
        (PAPER, PAPER, 0.0, InputError, "y_max is 0"),
        (PAPER, PAPER, -1.0, InputError, "y_max is -1"),
        (PAPER, PAPER, float("nan"), InputError, "y_max is nan"),
        (PAPER, PAPER, [1.0], InputError, r"y_max is \[1\.0\]; give"),
        ("PI", PAPER, 1.0, InputError, "the model is of type str"),
        (PAPER, None, 1.0, InputError, "the approximate inverse is of type NoneType"),
        (hyst.Stop(1.0), PAPER, 1.0, InputError, "holds a stop"),
        (PAPER @ PAPER, PAPER, 1.0, InputError, "2 banks of plays"),
        (PAPER, PAPER @ hyst.DeadZone([1.0], [0.0], "by-direction"), 1.0, InputError, "dead-zone"),
        (MEMORY, PAPER, 1.0, InputError, "from rest"),
        (hyst.PrandtlIshlinskii([1.0], [1.0]), PAPER, 1.0, NotInvertibleError, "p0 is 0"),
        (FLAT, PAPER, 1.0, NotInvertibleError, "flat around 0"),
    ],
)
def test_refusals(
    model: Operator,
    approximate: Operator,
    y_max: float,
    error: type[Exception],
    message: str,
) -> None:
    with pytest.raises(error, match=message):
        error_bound(model, approximate, y_max)


def test_models_with_maps_on_both_sides() -> None:
    bend, plays = hyst.DeadZone.odd([1.0, 0.5], [0.0, 1.0]), hyst.PrandtlIshlinskii([1], [1], 1.0)
    model = hyst.Affine(2.0, 1.0) @ plays @ bend
    assert error_bound(model, model.inverse(), 5.0).bound == pytest.approx(0.0, abs=1e-14)
    mapped = ModifiedPrandtlIshlinskii(plays, bend)
    assert error_bound(mapped, bend.inverse(), 5.0).map_error == 0.0
