"""Bouc-Wen models from records: the given case and its relatives, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.identification.fit.parametrization import Parametrization
from hyst.operators import Affine

Array = NDArray[np.float64]

NOISE, DT = 0.02, 1e-3
TRUTH = {"k": 0.6, "A": 0.35, "beta": 0.012, "gamma": 0.006}


def drive(high: float = 100.0, samples: int = 1500) -> Array:
    """Strokes from 0 that shrink towards the middle."""
    t = np.arange(samples) / samples
    size = np.where(t < 0.35, 1.0, np.exp(-1.5 * (t - 0.35)))
    return np.asarray(0.5 * high * (1.0 - size * np.cos(2.0 * np.pi * 6.0 * t)))


def printed_equation(u: Array) -> Array:
    """Give ``y = 0.6 u - z``, z' = 0.35 u' - 0.012 |u'| z - 0.006 u' |z|, by Runge's method."""

    def slope(z: float, du: float) -> float:
        return 0.35 * du - 0.012 * abs(du) * z - 0.006 * du * abs(z)

    z, found = 0.0, []
    for du in np.diff(u, prepend=0.0).tolist():
        for _ in range(20):
            half = z + 0.5 * slope(z, du / 20.0)
            z += slope(half, du / 20.0)
        found.append(z)
    return np.asarray(0.6 * u - np.array(found))


def within(found: hyst.Identified, truth: dict[str, float], most: float = 4.0) -> bool:
    """Tell whether constants are within some standard errors: of 16,000 one is not."""
    names = [each.split(".")[-1] for each in found.parameter_names]
    return all(
        abs(found.parameter_values[names.index(name)] - value)
        <= most * found.standard_errors[names.index(name)]
        for name, value in truth.items()
    )


def test_the_given_case(cases: Path) -> None:
    record = hyst.read_record(cases / "bouc-wen" / "loop.csv", input=1, output=2, time=0)
    found = hyst.identify(record, family="bouc-wen")
    assert found.delay == 0.0
    assert found.verdict.level == "good"
    assert within(found, TRUTH)
    # The record's own noise, 0.02 um, of its range.
    assert found.metrics["training"].rms < 1.02 * NOISE
    assert found.standard_errors[0] < 1e-3 * 0.6


@pytest.mark.parametrize(
    ("seed", "input_unit", "output_unit"),
    [(1, 1.0, 1.0), (2, 1e-3, 1e6), (3, 10.0, -1.0), (4, -1.0, 1.0)],
)
def test_its_relatives(seed: int, input_unit: float, output_unit: float) -> None:
    u = drive()
    y = printed_equation(u) + NOISE * np.random.default_rng(seed).normal(size=u.size)
    found = hyst.identify(hyst.Record(input_unit * u, output_unit * y, DT), family="bouc-wen")
    slope, hold = abs(output_unit / input_unit), 1.0 / abs(input_unit)
    scales = {"k": slope, "A": slope, "beta": hold, "gamma": hold}
    assert within(found, {name: value * scales[name] for name, value in TRUTH.items()})
    assert found.delay == 0.0
    assert found.verdict.level == "good"


@pytest.mark.parametrize(("n", "h", "phi"), [(0.6, 1.0, 0.0), (2.5, -1.0, 0.0), (1.0, 1.0, 0.3)])
def test_exponent_sign_and_asymmetry_are_found(n: float, h: float, phi: float) -> None:
    u = drive(2.0)
    model = hyst.BoucWen(1.4, 0.7, 1.3, 0.5, n, h, phi)
    y = Affine(1.0, 0.2)(model(u))
    y = y + 0.003 * np.ptp(y) * np.random.default_rng(6).normal(size=u.size)
    free = {"exponent": "free"} if phi == 0.0 else {"asymmetry": "free"}
    found = hyst.identify(hyst.Record(u, y, DT), family="bouc-wen", **free)
    asked = {"n": n} if phi == 0.0 else {"phi": phi}
    assert within(found, {"k": 1.4, "A": 0.7, "beta": 1.3, "gamma": 0.5, **asked})
    assert f"'h': {h}" in repr(found.model.to_dict())


def test_every_iterate_is_admissible(monkeypatch: pytest.MonkeyPatch) -> None:
    """A loop of plays asks for gamma beyond beta; the model refuses that in its constructor."""
    u = drive(2.0)
    plays = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], 0.5)(u)
    asked = []
    made = Parametrization.constants

    def noted(self: Parametrization, theta: Array) -> Array:
        asked.append(made(self, theta)[:6])
        return made(self, theta)

    monkeypatch.setattr(Parametrization, "constants", noted)
    record = hyst.Record(u, plays + 0.002 * np.random.default_rng(0).normal(size=u.size), DT)
    found = hyst.identify(record, family="bouc-wen", asymmetry="free", delay=0)
    _, a, beta, gamma, _, phi = np.array(asked).T
    assert len(asked) > 10
    assert np.all((a > 0.0) & (beta > 0.0) & (gamma <= beta) & (gamma > -beta))
    assert np.all(2.0 * np.abs(phi) < beta + gamma)
    assert found.verdict.level != "good"


def test_records_without_a_loop_are_refused() -> None:
    u = drive(2.0)
    noise = np.random.default_rng(3).normal(size=u.size)
    for y in (1.3 * u, 1.3 * u + 0.01 * noise, 1.3 * u + 0.2 * noise):
        with pytest.raises(hyst.NotIdentifiableError, match="no loop to identify"):
            hyst.identify(hyst.Record(u, y, DT), family="bouc-wen", delay=0)


def test_a_limit_that_is_far_is_told_as_an_extrapolation() -> None:
    u = drive(2.0)
    y = hyst.BoucWen(1.0, 0.3, 0.02, 0.01, h=-1.0)(u)  # a stroke is 6 % of the way to the limit
    y = y + 0.0005 * np.ptp(y) * np.random.default_rng(0).normal(size=u.size)
    found = hyst.identify(hyst.Record(u, y, DT), family="bouc-wen", delay=0)
    assert within(found, {"k": 1.0, "A": 0.3, "beta": 0.02, "gamma": 0.01})
    assert any("what limits z is an extrapolation" in note for note in found.undetermined)


def test_options_that_are_none_are_refused() -> None:
    record = hyst.Record(drive(2.0), drive(2.0), DT)
    with pytest.raises(hyst.InputError, match=r"exponent is 0\.05; give 0\.1 or more, or 'free'"):
        hyst.identify(record, family="bouc-wen", exponent=0.05)
    with pytest.raises(hyst.InputError, match=r"asymmetry is 'some'; choose one of equal, free"):
        hyst.identify(record, family="bouc-wen", asymmetry="some")
