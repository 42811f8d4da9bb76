"""Stages as the core has them: what is derived, what is held, what is copied."""

from __future__ import annotations

import re

import numpy as np
import pytest

from hyst import _engine, _single
from hyst.export.c.block import block_of
from hyst.export.c.core_sources import core_files, core_folder
from hyst.export.c.core_stage import core_stages
from hyst.export.c.stage_code import StageCode
from hyst.operators.stage import Stage
from reference.examples import EXAMPLES


def test_every_kind_of_stage_is_among_the_examples() -> None:
    kinds = {stage.kind for each in EXAMPLES.values() for stage in each.stages()}
    # Inverses of scheduled models alone; tests/models/test_scheduled.py has them.
    solved = {"affine_solved", "dead_zone_solved", "pi_solved"}
    assert kinds | solved == set(_engine.kinds())
    forms = {stage.form for each in EXAMPLES.values() for stage in core_stages(each)}
    assert forms >= {"HYST_POWER_LAW", "HYST_PLAYS", "HYST_POLYNOMIAL"}
    assert forms >= {"HYST_MEMORY_POWER", "HYST_MEMORY_POLYNOMIAL"}


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_stage_has_the_parameters_of_its_operator_in_their_order(name: str) -> None:
    model = EXAMPLES[name]
    constants = [each for stage in model.stages() for each in stage.constants]
    assert constants == model.parameters().values.tolist()


def test_constants_of_the_core_are_derived_as_written() -> None:
    """By hand: 2^c3 c2 / (c3 + 1) of a power law, slopes of plays, a rate times the sample time."""
    masing = {"inverse": 0, "last_reversal": 0, "depth": 2}
    fixed = {"least_slope": (0.0,), "dead_band": (0.0,)}
    power, plays, rated = (
        Stage("masing", (0.5, 3.0, 2.0), fixed, masing, "power-law"),
        Stage("masing", (1.0, -0.5, 0.25, 2.0, 4.0), fixed, masing, "plays"),
        Stage(
            "rate_dependent_pi",
            (1.0, 0.5, 2.0, 0.75, 1.5, 3.0, 7.0),
            fixed={"knees": (12.0,)},
            choices={"plays": 1, "powers": 2},
            dt=0.25,
        ),
    )
    chain = _engine.Chain([power, plays, rated])
    assert len(chain) == 3
    assert chain.constants(0)["numbers"] == {
        "dead_band": 0.0, "linear": 0.5, "factor": 4.0, "exponent": 3.0,
    }  # fmt: skip
    assert chain.constants(1)["tables"] == {
        "knot": (0.0, 2.0, 4.0), "value": (0.0, 2.0, 3.0), "slope": (1.0, 0.5, 0.75),
    }  # fmt: skip
    assert chain.constants(2)["numbers"] == {"p0": 1.0, "growth": 3.0}
    assert chain.constants(2)["tables"] == {
        "p": (0.5,), "r": (2.0,), "power": (24.0, 192.0), "weight": (28.0,), "threshold": (3.0,),
    }  # fmt: skip
    with pytest.raises(IndexError, match="no such stage"):
        chain.constants(3)


@pytest.mark.parametrize(
    ("stage", "what"),
    [
        (Stage("no_kind", (1.0,)), "unknown kind of stage 'no_kind'"),
        (Stage("pi", (1.0, 2.0)), "kind 'pi' has 2 constants, which do not fit"),
        (Stage("dead_zone", (1.0,)), "kind 'dead_zone' has 1 constants"),
        (Stage("state_space", (1.0,), choices={"order": 1, "delay": 0}), "'state_space' has 1"),
        (Stage("sections", (1.0,)), "'sections' has 1"),
        (Stage("rate_dependent_pi", (1.0, 0.0)), "lacks a choice or a fixed constant"),
        (Stage("masing", (1.0,), {"dead_band": (0.0,)}, form="table"), "loading curve 'table'"),
        (Stage("memory_element", (1.0,), form="plays"), "memory function 'plays'"),
    ],
)
def test_what_is_no_stage_is_refused(stage: Stage, what: str) -> None:
    with pytest.raises(ValueError, match=what):
        _engine.Chain([stage])


@pytest.mark.parametrize("name", EXAMPLES)
def test_memory_is_as_long_as_the_engine_s(name: str) -> None:
    model = EXAMPLES[name]
    chain = _engine.Chain(model.stages())
    code = StageCode(core_stages(model), "double")
    assert code.state_length == chain.state_length == model.initial_state().size


@pytest.mark.parametrize("name", EXAMPLES)
def test_held_and_fixed_constants_are_the_same(name: str) -> None:
    stages = core_stages(EXAMPLES[name])
    held = StageCode(stages, "double", "model->")
    assert held.constants() == StageCode(stages, "double").constants()
    members = held.declarations()
    for constant in held.constants():
        assert f"hyst_real {constant.name}" in members
        assert f"model->{constant.name}" in held.calls()


def test_the_core_in_single_computes_in_single() -> None:
    # By hand: p0 u + p z with z = u - r, every constant and every operation rounded to 24 bits.
    u, p0, p, r = (np.float32(each) for each in (0.7, 1.1, 0.3, 0.2))
    stage = ("pi", "", {"p0": 1.1}, {"p": [0.3], "r": [0.2]}, {})
    step = _single.Stepper([stage], [0.0])
    assert step(0.7) == float(p0 * u + p * (u - r))
    assert step(float("nan")) == float(p0 * u + p * (u - r))
    assert step.fault
    step.clear_fault()
    assert not step.fault
    assert step.state == [float(u - r)]


def test_only_what_is_needed_of_the_core_is_copied() -> None:
    def sources(name: str) -> set[str]:
        block = block_of(EXAMPLES[name], "double")
        includes = "".join(f'#include "{each}"\n' for each in block.headers)
        return {path for path in core_files(includes + block.body) if path.endswith(".c")}

    assert sources("affine") == set()
    assert sources("inverse of mpi") == {"src/dead_zone.c", "src/prandtl_ishlinskii.c"}
    assert sources("linear") == {"src/linear_dynamics.c"}
    assert sources("rate-dependent") == {
        "src/dead_zone.c", "src/prandtl_ishlinskii.c", "src/rate_dependent_prandtl_ishlinskii.c",
    }  # fmt: skip
    assert sources("ramberg-osgood") == {"src/loading_curve.c", "src/masing.c"}


def test_files_of_the_core_are_copied_unchanged() -> None:
    for path, content in core_files("hyst_masing_step(); hyst_sections_step();").items():
        assert content == (core_folder() / path).read_bytes()


def test_every_source_of_the_core_is_found_by_what_it_defines() -> None:
    """The search for definitions understands how the core is written."""
    folder = core_folder()
    for path in (folder / "SOURCES").read_text().split():
        name = path.removeprefix("src/").removesuffix(".c")
        lines = (folder / path).read_text().splitlines()
        # A definition starts in column 0 and its brace stands alone on a line after it.
        heads = [line for line in lines if re.match(r"[a-rt-z][^=]*\bhyst_\w+\(", line)]
        # What defines a row alone is needed by chains, which no export has.
        row_alone = any(line.startswith("const hyst_kind hyst_") for line in lines)
        assert heads or row_alone, name
        for head in heads:
            function = head[head.index("hyst_", head.index(" ")) :].split("(")[0]
            assert path in core_files(f"{function}(x);"), (name, function)
