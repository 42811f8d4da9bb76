"""What the report says of families whose inverse is no operator, or that have no plays."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import hyst
from hyst.report import write_report


def test_a_rate_dependent_model_is_named_explained_and_led_on(tmp_path: Path) -> None:
    stage = hyst.RateDependentPrandtlIshlinskii([0.4], [2.0], 2e-3, 1e-3, 1.0)
    records = []
    for f in (1.0, 10.0):
        u = 10.0 * np.sin(2.0 * np.pi * f * np.arange(round(3.0 / f / 1e-3)) * 1e-3)
        noise = np.random.default_rng(0).normal(0.0, 0.01, u.size)
        records.append(hyst.Record(u, stage(u) + noise, 1e-3))
    found = hyst.identify(records, family="rdpi", plays=1)
    write_report(found, records, (), tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "The model is a rate-dependent Prandtl-Ishlinskii model with 1 play." in page
    assert "|du/dt|" in page
    assert "(beta) is the growth of their radii" in page
    assert "--method trajectory -o command.csv" in page


def test_a_hammerstein_model_without_plays_explains_dynamics_and_no_plays(tmp_path: Path) -> None:
    u = hyst.signals.multisine(1e-3, 2000, amplitude=1.0, periods=2).u
    dynamics = hyst.LinearDynamics.from_zeros_poles_gain([], [0.5], 0.5, 1e-3)
    record = hyst.Record(u, dynamics(u) + 1e-3 * np.random.default_rng(0).normal(size=u.size), 1e-3)
    found = hyst.identify(record, family="hammerstein", hysteresis="linear", fir_order=20)
    write_report(found, record, (), tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "The model is a Hammerstein model (hysteresis, then linear dynamics)." in page
    assert "v(t) = gain" in page
    assert "y(t) = G[v](t)" in page
    assert "is a play" not in page
    method = "" if found.model.is_invertible() else " --method noncausal"
    assert f"--column 0{method} -o command.csv" in page
