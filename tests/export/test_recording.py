"""The recorder and the engine's chain are handed the same stages."""

from __future__ import annotations

import inspect
import re

import numpy as np
import pytest

from hyst import _engine, _single
from hyst.export.c.block import block_of
from hyst.export.c.core_sources import core_files, core_folder
from hyst.export.recording import Recorder, record_stages
from hyst.export.stage_code import StageCode
from hyst.operators.stage_sink import StageSink
from reference.examples import EXAMPLES


def stage_methods(owner: type) -> set[str]:
    return {name for name in dir(owner) if name.startswith("add_")}


def test_the_recorder_takes_all_that_the_engine_takes() -> None:
    assert stage_methods(Recorder) == stage_methods(_engine.Chain) == stage_methods(StageSink)
    for name in stage_methods(Recorder):
        declared = inspect.signature(getattr(StageSink, name))
        assert list(inspect.signature(getattr(Recorder, name)).parameters) == list(
            declared.parameters
        )


def test_every_kind_of_stage_is_among_the_examples() -> None:
    kinds = {stage.kind for each in EXAMPLES.values() for stage in record_stages(each)}
    assert len(kinds) == len(stage_methods(Recorder)) + 1  # dead zones are of two kinds
    forms = {stage.form for each in EXAMPLES.values() for stage in record_stages(each)}
    assert forms >= {"HYST_POWER_LAW", "HYST_PLAYS", "HYST_POLYNOMIAL"}
    assert forms >= {"HYST_MEMORY_POWER", "HYST_MEMORY_POLYNOMIAL"}


@pytest.mark.parametrize("name", EXAMPLES)
def test_memory_is_as_long_as_the_engine_s(name: str) -> None:
    model = EXAMPLES[name]
    chain = _engine.Chain()
    model.append_to(chain)
    code = StageCode(record_stages(model), "double")
    assert code.state_length == chain.state_length == model.initial_state().size


@pytest.mark.parametrize("name", EXAMPLES)
def test_held_and_fixed_constants_are_the_same(name: str) -> None:
    stages = record_stages(EXAMPLES[name])
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
        "src/dead_zone.c", "src/rate_dependent_prandtl_ishlinskii.c",
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
        assert heads, name
        for head in heads:
            function = head[head.index("hyst_", head.index(" ")) :].split("(")[0]
            assert path in core_files(f"{function}(x);"), (name, function)
