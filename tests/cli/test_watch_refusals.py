"""hyst watch: options, units and models that do not fit together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run
from watch_runs import COLUMNS, DT, END, reports, saved_stage, strokes, text_of

import hyst


@pytest.fixture
def model(folder: Path) -> Path:
    """The stage's model."""
    return saved_stage(folder)


REFUSALS = {
    "both clocks": (["--rate", 100, "--time", "t"], "give one"),
    "no clock": ([], "neither of --rate and --time"),
    "another column": (["--time", "when"], "no column 'when'"),
    "end": (["--time", "t", "--stop-after", "soon"], "give seconds, or at-end"),
    "every": (["--time", "t", "--every", 0], "--every"),
    "tolerance": (["--time", "t", "--tolerance", -1], "tolerance"),
    "only": (["--time", "t", "--only", "p[9]"], "p[9]"),
    "log": (["--time", "t", "--log", "model.json/x"], "model.json"),
    "resume": (["--time", "t", "--resume", "model.json"], "holds no estimator"),
}


@pytest.mark.parametrize("name", REFUSALS)
def test_what_makes_no_sense_is_refused(
    name: str, refused: Callable[..., str], model: Path, folder: Path
) -> None:
    (folder / "run.csv").write_text(text_of(strokes(2.0)))
    options, why = REFUSALS[name]
    assert why in refused("watch", "model.json", "run.csv", *COLUMNS, *END, *options)


def test_other_units_rates_and_models_are_refused(
    refused: Callable[..., str], run: Run, model: Path, folder: Path
) -> None:
    path = folder / "run.csv"
    path.write_text(text_of(strokes(2.0)).replace("[V]", "[mm]"))
    how = ("watch", "model.json", "run.csv", *COLUMNS, "--time", "t", *END)
    assert "'mm'" in refused(*how)
    path.write_text(text_of(strokes(2.0)))
    assert run(*how, "--log", "out").code in (0, 3)
    hyst.PrandtlIshlinskii([0.5], [0.5], 1.0).save(folder / "other.json")
    resume = ("--resume", "out/estimator.json")
    said = refused("watch", "other.json", *how[2:], *resume)
    assert "another model" in said
    path.write_text(text_of([line.replace(",", "0,", 1) for line in strokes(2.0)]))
    assert "0.01" in refused(*how[:-4], "--rate", 50, *END, *resume)
    assert "folder" in refused("watch", "model.json", ".", *COLUMNS, "--rate", 100)


def test_a_model_with_a_delay_is_compared_with_the_input_before(
    run: Run, folder: Path, model: Path
) -> None:
    about = hyst.load(model).description
    t = np.arange(1000) * DT
    u = 2.0 - 2.0 * np.cos(2.0 * np.pi * 2.0 * t)
    y = np.concatenate([np.full(3, STAGE(u)[0]), STAGE(u)[:-3]])
    rows = [f"{a:.2f},{b:.9f},{c:.9f}\n" for a, b, c in zip(t, u, y, strict=True)]
    (folder / "run.csv").write_text(text_of(rows))
    how = ("--time", "t", "--json", *END)
    STAGE.save(folder / "late.json", replace(about, delay=3))
    late = run("watch", "late.json", "run.csv", *COLUMNS, *how)
    assert late.code == 0, late
    # Nine digits in the file and no noise: what is left is rounding.
    assert reports(late)[-1]["model_error"] < 1e-8
    assert run("watch", "model.json", "run.csv", *COLUMNS, *how).code == 3
