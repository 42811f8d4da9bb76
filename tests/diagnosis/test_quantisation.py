"""Steps of converters are told with their size, and as a warning where they hide the loop."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import diagnosed, good, record
from healthy_records import triangle_wave

import hyst
from hyst.diagnosis.values.steps import levels_of


@pytest.mark.parametrize("step", [0.05, 0.25, 1.0 / 3.0])
@pytest.mark.parametrize("offset", [0.0, 1234.5])
def test_the_step_of_an_output(step: float, offset: float) -> None:
    u, y = good()
    counted = np.round(y / step) * step + offset
    (finding,) = diagnosed(record(u, counted)).named("quantisation")
    assert finding.severity == "remark"
    # Values are rounded doubles of up to 1300, whole steps apart.
    assert finding.amounts["step"] == pytest.approx(step, rel=1e-9)
    assert finding.amounts["levels"] == np.unique(np.round(y / step)).size


def test_a_coarse_step_is_a_warning() -> None:
    u, y = good()
    (finding,) = diagnosed(record(u, 2.0 * np.round(y / 2.0))).of("warning")
    assert finding.name == "quantisation"
    assert "steps of 2 um" in finding.sentence


def test_a_loop_of_few_steps_is_a_warning() -> None:
    u = triangle_wave(4000, 1000.0, 50.0)
    y = 0.5 * u + 0.3 * np.sign(hyst.Play(20.0)(u)) + 0.003 * u
    (finding,) = diagnosed(record(u, 0.25 * np.round(y / 0.25))).of("warning")
    assert "loop opens by" in finding.sentence


def test_the_step_of_an_input() -> None:
    u, y = good(kind="sine")
    (finding,) = diagnosed(record(np.round(u / 0.4) * 0.4, y)).named("quantisation")
    assert "input" in finding.sentence
    assert finding.amounts["step"] == pytest.approx(0.4, rel=1e-9)


def test_repeating_values_without_a_converter_have_no_step() -> None:
    t = np.arange(4000)
    assert levels_of(np.sin(2.0 * np.pi * t / 100.0)) is None
    assert levels_of(triangle_wave(4000, 1000.0, 50.0)) is None
    assert levels_of(np.random.default_rng(0).normal(size=4000)) is None
