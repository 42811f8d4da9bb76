"""Hysteresis that plays do not span, before a resonance: order and delay come out all the same."""

from __future__ import annotations

import numpy as np
import pytest
from test_identify_hammerstein import identified

import hyst
from hyst.models import LinearDynamics
from hyst.operators import Affine, Operator
from hyst.signals import Record
from reference.family_examples import family_example

DT, DELAY, RESONANCE, DAMPING = 1e-4, 3, 200.0, 0.03
NOISE = 10.0 ** (-45.0 / 20.0)

_W = 2.0 * np.pi * RESONANCE
STAGE = LinearDynamics.from_continuous([_W**2], [1.0, 2.0 * DAMPING * _W, _W**2], DT)
ACTUATOR = LinearDynamics(STAGE.A, STAGE.B, STAGE.C, STAGE.D, DT, DELAY)


def multisine(seed: int, highest: float, samples: int = 4000) -> np.ndarray:
    """Give lines from 2 Hz of equal size and random phase, of amplitude 1."""
    f = np.arange(samples // 2 + 1) / (samples * DT)
    phases = 2.0 * np.pi * np.random.default_rng(seed).random(f.size)
    u = np.fft.irfft(np.where((f >= 2.0) & (f <= highest), np.exp(1j * phases), 0.0), samples)
    return np.asarray(u / np.abs(u).max())


def record_of(front: Operator, seed: int) -> tuple[Record, np.ndarray]:
    """Give a record at 45 dB, and what it is without noise."""
    u = multisine(seed, 600.0)
    clean = (ACTUATOR @ front)(u)
    noise = NOISE * clean.std() * np.random.default_rng(seed).normal(size=u.size)
    return Record(u, clean + noise, DT), clean


@pytest.mark.parametrize(
    ("name", "front"),
    [
        ("dahl", Affine(-1.0, 0.3) @ hyst.Dahl(4.0, 1.5)),
        ("bouc-wen", Affine(-1.0, 0.3) @ hyst.BoucWen(1.2, 0.6, 1.4, 0.5, h=-1.0)),
    ],
)
def test_order_and_delay_are_those_of_the_stage_behind_friction(name: str, front: Operator) -> None:
    """Plays need a pole more, and another delay, to follow loops that forget no turn at once."""
    record, clean = record_of(front, 1)
    found = identified(record, hysteresis=name)
    assert (found.dynamics.order, found.dynamics.delay) == (2, DELAY)
    assert found.dynamics.D == 0.0
    # A tenth of the noise: ten constants and 4000 samples leave 0.05 of it.
    assert np.std(found.model(record.u) - clean) < 0.1 * NOISE * clean.std()
    assert found.verdict.level == "good"


def test_a_butterfly_may_be_in_front() -> None:
    """It is even: plays alone follow none of it."""
    front = family_example("butterfly").model
    record, clean = record_of(front, 3)
    found = identified(record, hysteresis="butterfly", plays=2, knots=4)
    assert found.dynamics.order == 2
    poles = np.log(found.dynamics.poles()) / DT
    assert np.abs(poles) / (2.0 * np.pi) == pytest.approx(RESONANCE, rel=1e-3)
    # The envelope has knots where the family puts them, not where they are.
    assert np.std(found.model(record.u) - clean) < 0.05 * clean.std()


def test_a_hysteresis_of_another_kind_gets_no_resonance_of_its_own() -> None:
    """Knots that are elsewhere leave errors around the resonance, which a second one follows."""
    front = family_example("gpi").model
    record, clean = record_of(front, 7)
    found = identified(record, hysteresis="gpi")
    assert (found.dynamics.order, found.dynamics.delay) == (2, DELAY)
    assert np.std(found.model(record.u) - clean) < 0.02 * clean.std()
