"""Envelopes with knots at given places, and of any shape."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_records import drive

import hyst
from hyst.errors import InputError, NotInvertibleError
from hyst.signals import Record

PLAYS = hyst.PrandtlIshlinskii([0.4, 0.3], [0.2, 0.5], p0=0.3)


def record_of(envelope: hyst.DeadZone, samples: int = 3000) -> Record:
    u = 2.0 * drive(samples)
    return Record(u, (hyst.Affine(1.0, 0.3) @ PLAYS @ envelope)(u), 1e-3)


def test_knots_stay_at_their_places() -> None:
    envelope = hyst.DeadZone([1.0, 0.4, -0.3], [0.0, 0.7, -0.9])
    found = hyst.identify(record_of(envelope), family="gpi", knots=[0.7, -0.9], plays=2, delay=0)
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    by_place = [values["dead_zone.weights[3]"], values["dead_zone.weights[2]"]]
    assert by_place == pytest.approx([0.4, -0.3], abs=1e-6)
    assert found.model.is_invertible()


def test_an_envelope_of_any_shape_is_found_with_its_knots() -> None:
    """It rises, and falls beyond 0.8: no inverse, and plays that add up to 1."""
    envelope = hyst.DeadZone([1.0, -1.6], [0.0, 0.8])
    record = record_of(envelope)
    found = hyst.identify(record, family="gpi", envelope="free", knots=3, plays=2, delay=0)
    assert found.metrics["training"].rms_percent < 0.1
    monotone = hyst.identify(record, family="gpi", knots=3, plays=2, delay=0)
    assert monotone.metrics["training"].rms > 10.0 * found.metrics["training"].rms
    with pytest.raises(NotInvertibleError):
        found.model.inverse()
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    weights = [values[f"prandtl_ishlinskii.{each}"] for each in ("p0", "p[1]", "p[2]")]
    total = PLAYS.p0 + PLAYS.p.sum()
    scale = np.sum(weights) / total
    assert np.array(weights) / scale == pytest.approx([PLAYS.p0, *PLAYS.p], abs=0.02)


def test_what_an_envelope_cannot_be_is_refused() -> None:
    with pytest.raises(InputError, match="envelope is 'bent'; choose one of monotone, free"):
        hyst.families.GeneralizedPrandtlIshlinskii(envelope="bent")
    with pytest.raises(InputError, match="a free envelope has no inverse; leave out weights"):
        hyst.families.GeneralizedPrandtlIshlinskii(envelope="free", weights="invertible")
    with pytest.raises(InputError, match="places of knots behind the plays follow from the output"):
        hyst.families.ModifiedPrandtlIshlinskii(knots=[1.0, 2.0])
    for knots in ([], [np.nan], "many", 0, [[1.0]], [0.1 * i for i in range(60)]):
        with pytest.raises(InputError, match="knots"):
            hyst.families.GeneralizedPrandtlIshlinskii(knots=knots)
