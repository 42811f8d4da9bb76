"""The spec of hyst observer: plants from model files, and what is not known of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hyst
from hyst.cli.observer.spec import ObserverSpec, read_spec
from hyst.cli.observer.template import TEMPLATE
from hyst.control import identification_weight, identified_plant

DT = 5e-4
W = 2.0 * np.pi * 120.0
G = hyst.LinearDynamics.from_continuous([W * W], [1.0, 0.1 * W, W * W], DT, delay=2)
PI = hyst.PrandtlIshlinskii([0.3, 0.2], [1.0, 3.0], 0.8)
F = np.geomspace(1.0, 900.0, 60)

SPEC = """
[plant]
file = "model.json"
[controller]
num = [20.0]
den = [1.0, 0.0]
[weights]
Wu = "identification"
Wp = { num = [0.5, 20.0], den = [1.0, 0.2] }
[internal_model]
kind = "integrator"
[inverse]
kind = "exact"
[reference]
sines = [[5.0, 2.0]]
duration = 1.0
[simulation]
settle = 0.5
[filter]
"""


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a model as hyst identify writes it, and two measured responses."""
    folder = tmp_path_factory.mktemp("stage")
    u = hyst.signals.multisine(DT, 3000, amplitude=10.0).u
    y = (G @ PI)(u)
    y = y + 0.02 * y.std() * np.random.default_rng(0).normal(size=y.size)
    options = {"hysteresis": "pi", "plays": 2, "state_order": 2}
    found = hyst.identify(hyst.Record(u, y, DT), family="hammerstein", **options)
    found.model.save(folder / "model.json")
    PI.save(folder / "hysteresis.json")
    for name, factor in (("stiff", 1.1), ("soft", 0.9)):
        w = factor * W
        late = hyst.LinearDynamics.from_continuous([w * w], [1.0, 0.1 * w, w * w], DT, delay=2)
        values = late.frequency_response(F)
        rows = np.column_stack([F, np.abs(values), np.degrees(np.angle(values))])
        header = "frequency [Hz],magnitude,phase [deg]"
        np.savetxt(folder / f"{name}.csv", rows, "%.17g", ",", header=header, comments="")
    return folder


def read(folder: Path, text: str = SPEC) -> ObserverSpec:
    path = folder / "spec.toml"
    path.write_text(text, encoding="utf-8")
    return read_spec(path)


def gain(system: Any, frequency: np.ndarray = F) -> np.ndarray:
    w = 2.0 * np.pi * frequency
    points = 1j * w if system.dt == 0.0 else np.exp(1j * w * system.dt)
    return np.abs(system.response(points)[:, 0, 0])


def test_a_model_file_alone_gives_plant_hysteresis_sample_time_and_weight(stage: Path) -> None:
    spec = read(stage)
    model = hyst.load(stage / "model.json")
    plant = identified_plant(model)
    assert spec.identified is not None
    assert (spec.plant.dt, spec.filter_dt, spec.delay) == (DT, DT, 0.0)
    assert spec.plant.order == 4  # two samples of delay among the states
    assert spec.hysteresis == plant.hysteresis
    assert spec.hysteresis.description.verdict.level == "good"
    assert spec.reference.size == 2000  # at the samples of the block
    np.testing.assert_allclose(gain(spec.plant), np.abs(G.frequency_response(F)), rtol=0.01)
    np.testing.assert_array_equal(gain(spec.Wu), gain(identification_weight(plant).system))


def test_the_hysteresis_may_name_the_same_file(stage: Path) -> None:
    both = read(stage, SPEC + '[hysteresis]\nfile = "./model.json"\n')
    assert both.hysteresis == read(stage).hysteresis


def test_the_continuous_form_has_its_dead_time_beside_it(stage: Path) -> None:
    text = SPEC.replace('"model.json"', '"model.json"\nform = "continuous"\ndelay = 0.0002')
    spec = read(stage, text + "delay = 0.0001\n")
    assert spec.plant.dt == spec.Wu.dt == 0.0
    # Two samples, 0.2 ms of [plant] and 0.1 ms of [filter]; noise adds parts of a sample.
    assert spec.delay == pytest.approx(0.0013, abs=5e-6)


def test_a_written_plant_may_have_a_delay(stage: Path) -> None:
    late = TEMPLATE.replace("[plant]", "[plant]\ndelay = 0.0003")
    spec = read(stage, late.replace("delay = 0.0  ", "delay = 0.0001  "))
    assert spec.delay == pytest.approx(0.0004, rel=1e-12)
    assert spec.identified is None
    assert (spec.plant.order, spec.plant.dt) == (2, 0.0)


def test_measured_responses_are_covered(stage: Path) -> None:
    spec = read(
        stage, SPEC.replace('"identification"', '{ responses = ["stiff.csv", "soft.csv"] }')
    )
    nominal = hyst.load(stage / "model.json")
    plant = identified_plant(nominal)
    for name in ("stiff", "soft"):
        measured = hyst.read_frequency_response(stage / f"{name}.csv")
        off = np.abs(measured.response / plant.dynamics.frequency_response(F) - 1.0)
        assert np.all(off <= gain(spec.Wu) * (1.0 + 1e-9))
    assert gain(spec.Wu).max() < 3.0  # a resonance that moves by a tenth, damping 0.05


def test_responses_of_a_late_plant_are_compared_with_its_delay(stage: Path) -> None:
    late = TEMPLATE.replace("[plant]", "[plant]\ndelay = 0.00125")  # two samples, and half a hold
    start = late.index("num = [319775")
    late = late.replace(
        late[start : late.index("[true_plant]")],
        f"num = [{W * W}]\nden = [1.0, {0.1 * W}, {W * W}]\n",
    )
    start = late.index("Wu = {")
    told = 'Wu = { responses = ["stiff.csv"], order = 3, least = 0.02, matched_at = 5.0 }\n'
    spec = read(stage, late.replace(late[start : late.index("# What is wanted")], told))
    assert spec.Wu.order == 3
    s = 2j * np.pi * F
    Pn = W * W / (s * s + 0.1 * W * s + W * W) * np.exp(-0.00125 * s)
    measured = hyst.read_frequency_response(stage / "stiff.csv").response
    off = np.abs(measured / Pn - 1.0)
    assert np.all(off <= gain(spec.Wu) * 1.01 + 1e-3)  # matched at 5 Hz, where both are 1 to 1e-3
    assert gain(spec.Wu, np.array([2.0]))[0] < 0.1


NUMBERS = "{ num = [0.0001], den = [1.0] }"


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            "[filter]",
            "[filter]\ndt = 1e-4",
            r"\[filter\] dt is 0\.0001 s, and the plant .* 0\.0005",
        ),
        ('"identification"', NUMBERS, r"Wu is 0\.0001 at .* Hz, where the identification of .*"),
        ('"identification"', '"identify"', "Wu is 'identify'; give a system"),
        ('"identification"', "{ responses = [] }", r"Wu responses is \[\]; give files"),
        ('"identification"', '{ responses = ["no.csv"] }', r"no\.csv"),
        ('"identification"', '{ responses = ["stiff.csv"], order = 9 }', "order is 9"),
        ('"identification"', '{ responses = ["stiff.csv"], odrer = 2 }', "did you mean 'order'"),
        ('"model.json"', '"model.json"\ndelay = 0.0003', r"0\.6 samples of its dt"),
        ('"model.json"', '"model.json"\ndelay = -1', r"\[plant\] delay is -1"),
        ('"model.json"', '"model.json"\nform = "exact"', "form is 'exact'"),
        ('"model.json"', '"model.json"\nnum = [1.0]', "unknown entry 'num'"),
        ('"model.json"', '"hysteresis.json"', "holds no dynamics behind a hysteresis"),
        ('"model.json"', '"no.json"', "cannot be read"),
        (
            "[inverse]",
            '[hysteresis]\nfile = "hysteresis.json"\n[inverse]',
            "leave .hysteresis. out, or name the same file",
        ),
        (
            "[inverse]",
            "[hysteresis]\np0 = 1.0\np = []\nr = []\n[inverse]",
            "leave .hysteresis. out",
        ),
    ],
)
def test_mistakes_are_named(stage: Path, old: str, new: str, told: str) -> None:
    assert old in SPEC
    with pytest.raises(hyst.InputError, match=told):
        read(stage, SPEC.replace(old, new, 1))


def test_a_model_with_dynamics_is_no_hysteresis(stage: Path) -> None:
    start = TEMPLATE.index("p0 = 0.1")
    end = TEMPLATE.index("[inverse]")
    text = TEMPLATE.replace(TEMPLATE[start:end], 'file = "model.json"\n')
    with pytest.raises(hyst.InputError, match=r"hysteresis and dynamics: name it under \[plant\]"):
        read(stage, text)


def test_a_written_plant_has_no_identification(stage: Path) -> None:
    start = TEMPLATE.index("Wu = {")
    end = TEMPLATE.index("# What is wanted")
    text = TEMPLATE.replace(TEMPLATE[start:end], 'Wu = "identification"\n')
    with pytest.raises(hyst.InputError, match="the plant is written; name a model file"):
        read(stage, text)


def test_a_file_without_errors_of_dynamics_is_told(stage: Path) -> None:
    content = json.loads((stage / "model.json").read_text(encoding="utf-8"))
    del content["description"]["dynamics_errors"]
    old = json.dumps(content | {"version": 3})
    (stage / "old.json").write_text(old, encoding="utf-8")
    text = SPEC.replace("model.json", "old.json")
    with pytest.raises(hyst.InputError, match="does not tell how well its dynamics are known"):
        read(stage, text)
    assert read(stage, text.replace('"identification"', NUMBERS)).plant.dt == DT
