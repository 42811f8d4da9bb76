"""hyst observer: what page and verdict say is of the block beside them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
from command_runs import Run

import hyst
from hyst.cli.observer.template import TEMPLATE

# As quick as it can be: one period after the start is left out.
QUICK = TEMPLATE.replace("duration = 3.0", "duration = 1.5").replace("settle = 1.0", "settle = 0.5")
LIMITED = "drive = [-20.0, 20.0]"


def test_a_page_has_no_block_of_another_run_beside_it(run: Run, folder: Path) -> None:
    """A block that is not safe takes the file of an earlier, safe one away; and says what to do."""
    (folder / "spec.toml").write_text(QUICK, encoding="utf-8")
    assert run("observer", "spec.toml", "-o", "out").code == 0
    assert (folder / "out" / "controller.json").exists()
    steep = QUICK.replace('kind = "scaled"\nfactor = 0.7', 'kind = "none"')
    (folder / "spec.toml").write_text(steep, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out", "--force")
    assert "NOT SAFE" in ended.out
    assert not (folder / "out" / "controller.json").exists()
    # The design in continuous time knows nothing of the inverse: its praise is not repeated here.
    answer = ended.out.splitlines()[0]
    assert "with this one (none)" in answer
    assert "stable for every plant within Wu, 1.3 times over" not in answer


def test_a_delay_that_the_controller_does_not_bear_is_not_put_on_sampling(
    run: Run, folder: Path
) -> None:
    (folder / "spec.toml").write_text(QUICK.replace("delay = 0.0", "delay = 2e-3"), "utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
    # Its delay margin is 0.75 ms, whatever the design and however fast it is sampled.
    assert "The controller alone does not stabilize" in ended.out
    assert "0.002 s late" in ended.out
    assert "sampling breaks it" not in ended.out


def test_a_drive_at_its_limits_is_told_in_the_verdict(run: Run, folder: Path) -> None:
    text = QUICK.replace("# [limits]", "[limits]").replace("# drive = [-50.0, 50.0]", LIMITED)
    assert text.count(LIMITED) == 1
    (folder / "spec.toml").write_text(text, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
    # The exact inverse needs 37 for this reference.
    assert "BUT the drive met its limits" in ended.out.splitlines()[0]


def test_a_model_that_is_unfit_is_not_called_safe_without_a_word(
    run: Run, folder: Path, refused: Callable[..., str]
) -> None:
    verdict = hyst.operators.Verdict("unfit", ("It does not describe the record.",))
    about = hyst.operators.ModelDescription(verdict=verdict)
    hyst.PrandtlIshlinskii([0.3], [1.0], 0.8).save(folder / "model.json", about)
    plays = QUICK[QUICK.index("p0 = 0.1") : QUICK.index("# envelope")]
    text = QUICK.replace(plays, 'file = "model.json"\n')
    (folder / "spec.toml").write_text(text, encoding="utf-8")
    assert "unfit" in refused("observer", "spec.toml", "-o", "out")
    ended = run("observer", "spec.toml", "-o", "out", "--despite-verdict")
    assert "BUT the verdict on the model is unfit" in ended.out.splitlines()[0]


def test_poles_are_told_of_the_block_apart_from_those_of_its_design(run: Run, folder: Path) -> None:
    (folder / "spec.toml").write_text(QUICK, encoding="utf-8")
    assert run("observer", "spec.toml", "-o", "out").code == 0
    out = folder / "out"
    page = (out / "report.html").read_text(encoding="utf-8")
    block = hyst.load(out / "controller.json")
    fastest = np.abs(np.log(np.linalg.eigvals(block.A).astype(complex))).max() / block.dt
    # Four digits are told.
    assert f"{fastest / (2.0 * np.pi):.4g} Hz; half the sample rate" in page
    assert "continuous design: Q(s) denominator" in page


# A stage of 500 Hz with an optimistic Wu and 0.05 um of noise, followed slowly: an observer once
# called safe made its drive jump by 5.9 V from sample to sample, for a tenth of a per cent.
QUIET = """
[plant]
num = [9869604.4]
den = [1.0, 314.159, 9869604.4]
[controller]
num = [0.02, 150.0]
den = [1.0, 0.0]
[weights]
Wu = { num = [2.0, 0.0], den = [1.0, 31416.0] }
Wp = { num = [0.5, 188.0], den = [1.0, 0.1] }
[internal_model]
kind = "integrator"
[hysteresis]
p0 = 0.6
p = [0.12, 0.09, 0.08, 0.06, 0.05]
r = [0.5, 1.5, 3.0, 5.0, 8.0]
[inverse]
kind = "exact"
[reference]
sines = [[10.0, 10.0]]
duration = 0.6
[simulation]
settle = 0.4
noise = 0.05
[filter]
dt = 1e-4
"""


def test_what_buys_nothing_is_told_with_its_price(run: Run, folder: Path) -> None:
    (folder / "spec.toml").write_text(QUIET, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
    assert ended.code == 0
    assert "The observer buys nothing here" in ended.out
    assert "BUT sensor noise of 0.05 makes the drive jump by" in ended.out
    assert "The observer buys nothing here" in (folder / "out" / "report.html").read_text("utf-8")
    told = json.loads((folder / "out" / "certificate.json").read_text(encoding="utf-8"))
    row = told["tracking"]["exact"]
    assert row["with_observer"]["rms"] > 0.95 * row["without"]["rms"]
    # The design pays for noise: 0.1 V is far below 5.9 V, and above what the controller makes.
    assert row["without"]["noise_jitter"] < row["with_observer"]["noise_jitter"] < 0.1
