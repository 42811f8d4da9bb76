"""Hysteresis, creep and lag together have an exact inverse from the first sample on."""

from __future__ import annotations

import numpy as np
import pytest

import hyst

DT = 1e-3
PLAYS = hyst.PrandtlIshlinskii([0.5, 0.3, 0.1], [0.1, 0.4, 0.9], p0=1.0)
BEND = hyst.DeadZone.odd([1.0, 0.2, -0.1], [0.0, 0.3, 0.6])
CREEP = hyst.Creep([0.02, 0.03, 0.01], [0.013, 0.7, 19.0], DT, rest=0.2)
LAG = hyst.Lag(0.42 * DT, DT)

HYSTERESIS = {
    "plays": PLAYS,
    "gpi": hyst.GeneralizedPrandtlIshlinskii(BEND, PLAYS),
    "mpi": hyst.ModifiedPrandtlIshlinskii(PLAYS, BEND),
    "bouc-wen": hyst.BoucWen(1.1, 0.4, 0.2, 0.1, 1.5),
}


def reference(seed: int) -> np.ndarray:
    """Begins anywhere, with jumps among it."""
    generator = np.random.default_rng(seed)
    y = 0.3 + generator.normal(size=3000).cumsum() / 30.0
    y[1000:1500] += 0.8
    return np.asarray(y)


@pytest.mark.parametrize("name", HYSTERESIS)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("scale", [1.0, 3e-7, -5e4])
def test_commands_reach_what_was_wanted(name: str, seed: int, scale: float) -> None:
    model = hyst.Affine(scale, 0.1 * scale) @ CREEP @ HYSTERESIS[name] @ LAG
    wanted = scale * reference(seed)
    # Some ten roundings of every stage on each of the two ways.
    assert np.abs(model(model.inverse()(wanted)) - wanted).max() <= 2e-14 * np.ptp(wanted)


@pytest.mark.parametrize("name", HYSTERESIS)
@pytest.mark.parametrize("seed", range(3))
def test_what_was_given_is_found_again(name: str, seed: int) -> None:
    model, u = hyst.Affine(3.0, 0.1) @ CREEP @ HYSTERESIS[name] @ LAG, reference(seed)
    # The same roundings, those behind the lag made larger by its inverse, at most 3.3 times.
    assert np.abs(model.inverse()(model(u)) - u).max() <= 1e-12 * np.ptp(u)


def test_they_are_saved_and_loaded(tmp_path) -> None:
    model = hyst.Affine(3.0, 0.1) @ CREEP @ HYSTERESIS["mpi"] @ hyst.Delay(0.2, DT) @ LAG
    for name, operator in (("model", model), ("inverse", model.inverse())):
        operator.save(tmp_path / f"{name}.json")
        again = hyst.load(tmp_path / f"{name}.json")
        assert again == operator
        assert again(reference(7)).tolist() == operator(reference(7)).tolist()


def test_without_its_creep_or_its_lag_a_model_misses() -> None:
    """What the exactness is worth: commands of the hysteresis alone."""
    plant = CREEP @ PLAYS @ LAG
    wanted = 0.8 * np.sin(np.arange(3000) / 40.0)
    missed = np.abs(plant(PLAYS.inverse()(wanted)) - wanted).max()
    assert missed > 0.01
