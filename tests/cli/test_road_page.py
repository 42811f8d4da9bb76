"""The tutorial of a resonant stage, run as it stands: what it says is of the files it makes."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, snapshot
from pages import blocks

import hyst
from hyst.control import identification_weight, identified_plant, sampled_certificate

PAGE = "tutorials/hammerstein_and_observer.md"


def sources(folder: Path) -> dict[str, bytes]:
    return {name: each for name, each in snapshot(folder).items() if name.endswith((".c", ".h"))}


def test_five_commands_lead_from_a_record_to_the_block(run: Run, folder: Path) -> None:
    commands = [shlex.split(each) for each in blocks(PAGE, "bash")]
    assert [each[:2] for each in commands] == [
        ["hyst", verb] for verb in ("excite", "diagnose", "identify", "observer", "export")
    ]
    (folder / "spec.toml").write_text(blocks(PAGE, "toml")[0], encoding="utf-8")
    told = ""
    for number, command in enumerate(commands):
        ended = run(*command[1:])
        assert ended.code == 0, ended.err
        told += ended.out
        if number == 0:
            exec(compile(blocks(PAGE, "python")[0], PAGE, "exec"), {})
    words = " ".join(told.split())
    for each in blocks(PAGE, "text"):
        for line in each.splitlines():
            assert line in words
    assert re.search(r"^SAFE: ", told, re.M)

    # The certificate is of the block in the file, for the plant and the weight of the model file.
    plant = identified_plant(folder / "stage" / "model.json")
    block = hyst.load(folder / "loop" / "controller.json")
    certificate = json.loads((folder / "loop" / "certificate.json").read_text(encoding="utf-8"))
    assert certificate["safe"] is True
    Wu = identification_weight(plant)
    again = sampled_certificate(block, plant, Wu, ([0.5, 60.0], [1.0, 0.5]))
    for name in ("uncertainty_norm", "performance_norm", "noise_gain", "noise_rms"):
        # Saved and read again to the last digit; norms are searched for to 1e-8.
        assert getattr(again, name) == pytest.approx(certificate["sampled"][name], rel=1e-6)

    # The true stage is within what the identification left open, and the block tracks it.
    w = 2.0 * np.pi * 120.0
    true = hyst.LinearDynamics.from_continuous([w * w], [1.0, 0.1 * w, w * w], plant.dt, delay=2)
    f = np.linspace(1.0, 0.999 * 0.5 / plant.dt, 300)
    off = np.abs(true.frequency_response(f) / plant.dynamics.frequency_response(f) - 1.0)
    gain = np.abs(Wu.system.response(np.exp(2j * np.pi * f * plant.dt))[:, 0, 0])
    assert np.all(off <= gain)
    t = plant.dt * np.arange(2000)
    loop = hyst.control.simulate_closed_loop(
        5.0 * np.sin(10.0 * np.pi * t),
        plant.dt,
        plant=true,
        controller=block,
        hysteresis=hyst.PrandtlIshlinskii([0.3, 0.2], [1.0, 3.0], 0.8),
        settle=0.5,
    )
    signals = np.genfromtxt(folder / "loop" / "signals.csv", delimiter=",", names=True)
    late = signals["time_s"] >= 0.5
    told_rms = np.sqrt(np.mean(np.square((signals["y_ref"] - signals["y"])[late])))
    ours = np.sqrt(np.mean(np.square((loop.r - loop.y)[t >= 0.5])))
    # Two draws of a model that misses by 0.1 %, and noise of 0.02 beside 0.06 of error.
    assert abs(ours - told_rms) < 0.02

    # The code is of the same block: exported from what the file holds, it is the same.
    hyst.export.c_project(block, folder / "again")
    first, second = sources(folder / "code"), sources(folder / "again")
    assert first == second != {}
