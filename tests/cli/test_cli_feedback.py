"""hyst observer with a designed controller, feedforward, and a reference around an offset."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run

from hyst.cli.observer.template import TEMPLATE

WRITTEN = "num = [4.0, 8.0]\nden = [1.0, 0.0]\n"
SINES = "sines = [[18.0, 1.0], [28.0, 3.0]]\nduration = 3.0\n"
DESIGNED = 'kind = "pi"\nfeedforward = true\n'
LIFTED = "sines = [[5.0, 2.0, 90.0]]\noffset = 40.0\nramp = 0.4\nduration = 1.0\n"


def spec(controller: str = WRITTEN, reference: str = SINES, more: str = "") -> str:
    text = TEMPLATE.replace(WRITTEN, controller).replace(SINES, reference)
    assert WRITTEN in TEMPLATE
    assert SINES in TEMPLATE
    text = text.replace("settle = 1.0", "settle = 0.5")
    return text.replace("noise = 0.0 ", "noise = 0.001 ") + more


def test_a_designed_controller_with_feedforward_and_offset(run: Run, folder: Path) -> None:
    (folder / "spec.toml").write_text(spec(DESIGNED, LIFTED), encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
    assert ended.code == 0, ended.err
    told = json.loads((folder / "out" / "certificate.json").read_text(encoding="utf-8"))
    assert told["safe"] is True
    # Ms of C alone is what the design asks for; the observer is another loop.
    assert told["margins"]["controller"]["peak_sensitivity"] == pytest.approx(1.5, abs=0.01)
    assert told["margins"]["block"]["stable"] is True
    for words in ("controller", "PI, ki", "gain margin", "inverse + feedback + feedforward"):
        assert words in ended.out
        assert words in (folder / "out" / "report.html").read_text(encoding="utf-8")
    signals = np.genfromtxt(folder / "out" / "signals.csv", delimiter=",", skip_header=1)
    t, y_ref, y, u = signals[:, 0], signals[:, 1], signals[:, 2], signals[:, 3]
    # It starts at rest without drive, rises, and is at offset + sine, with its phase, after 0.4 s.
    assert y_ref[0] == 0.0
    assert abs(y[0]) < 1e-9
    assert abs(u[0]) < 0.1
    late = t >= 0.4
    assert y_ref[late] == pytest.approx(40.0 + 5.0 * np.cos(4.0 * np.pi * t[late]), abs=1e-9)
    assert u.min() > -1.0
    # At 2 Hz the plant lags by 0.036, of which |S| leaves a part; without feedforward C = 4 + 8/s
    # leaves a fifth of the amplitude.
    assert told["tracking"]["exact"]["without"]["rms"] < 0.036 * 5.0


def test_an_offset_without_ramp_starts_settled(run: Run, folder: Path) -> None:
    lifted = LIFTED.replace("ramp = 0.4\n", "").replace("[5.0, 2.0, 90.0]", "[5.0, 2.0]")
    (folder / "spec.toml").write_text(spec(reference=lifted), encoding="utf-8")
    assert run("observer", "spec.toml", "-o", "out").code == 0
    signals = np.genfromtxt(folder / "out" / "signals.csv", delimiter=",", skip_header=1)
    # The template's inverse is 0.7 of the exact one: the loop rests at 40 all the same.
    assert signals[0, 2] == pytest.approx(40.0, abs=1e-6)
    assert np.abs(np.diff(signals[:20, 2])).max() < 0.01


MISTAKES = {
    "[controller] kind is 'p'": spec('kind = "p"\n'),
    "[controller] cannot be designed: mismatch is 0.9": spec('kind = "pi"\nmismatch = 0.9\n'),
    "[controller] has an unknown entry 'num'": spec('kind = "pi"\n' + WRITTEN),
    "[controller] feedforward is 'yes'": spec(WRITTEN + 'feedforward = "yes"\n'),
    "[filter] method is 'zoh'": spec(DESIGNED).replace('method = "tustin"', 'method = "zoh"'),
    "[reference] ramp is 3 s of 3 s": spec(reference=SINES + "ramp = 3.0\n"),
    "[reference] ramp is -1": spec(reference=SINES + "ramp = -1.0\n"),
    "[reference] start is 'later'": spec(reference=SINES + 'start = "later"\n'),
    "[reference] sines is 'sin'": spec(reference='sines = "sin"\nduration = 1.0\n'),
}


@pytest.mark.parametrize("said", MISTAKES)
def test_mistakes(said: str, folder: Path, refused: Callable[..., str]) -> None:
    (folder / "spec.toml").write_text(MISTAKES[said], encoding="utf-8")
    assert said in refused("observer", "spec.toml", "-o", "out")
