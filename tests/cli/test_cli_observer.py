"""hyst observer: the template runs, the answer is honest, mistakes in a spec are named."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_runs import Run

import hyst
from hyst.cli import main
from hyst.cli.observer.template import TEMPLATE

# As quick as it can be: one period after the start is left out.
QUICK = TEMPLATE.replace("duration = 3.0", "duration = 1.5").replace("settle = 1.0", "settle = 0.5")
LIMITED = "drive = [-20.0, 20.0]"
PRINTED = QUICK.replace("num = [4.0, 8.0]", "num = [8.0, 4.0]")


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, str], Path]:
    """Design from a spec, once for each name."""
    folder = tmp_path_factory.mktemp("observer")

    def design(name: str, text: str) -> Path:
        if not (folder / name).exists():
            (folder / f"{name}.toml").write_text(text, encoding="utf-8")
            assert main(["observer", str(folder / f"{name}.toml"), "-o", str(folder / name)]) == 0
        return folder / name

    return design


def test_the_template_is_printed_and_read(run: Run, folder: Path) -> None:
    ended = run("observer", "--template")
    assert (ended.code, ended.out, ended.err) == (0, TEMPLATE, "")


def test_the_template_gives_a_safe_loop(answered: Callable[[str, str], Path]) -> None:
    out = answered("repaired", QUICK)
    names = {each.name for each in out.iterdir()}
    assert names == {
        *("certificate.json", "controller.json", "report.html", "signals.csv"),
        *("bode.png", "closed_loop.png"),
    }
    told = json.loads((out / "certificate.json").read_text(encoding="utf-8"))
    assert told["safe"] is True
    # The notes on the paper: 0.9238 is the best known, to the digits the search is asked for.
    assert 0.92 < told["gamma"] < 0.93
    assert told["slope_proof"] < 1.0
    # The audit's own frequency responses: 0.779 without what folds down.
    assert told["sampled"]["baseband_norm"] == pytest.approx(0.779, abs=1e-3)
    scaled = told["tracking"]["0.7 of the exact"]
    exact = told["tracking"]["exact"]["without"]["rms"]
    recovered = (scaled["without"]["rms"] - scaled["with_observer"]["rms"]) / (
        scaled["without"]["rms"] - exact
    )
    assert recovered > 0.95
    assert "Hz, where |E| first is 0.707" in (out / "report.html").read_text(encoding="utf-8")
    assert told["verdict"] in (out / "report.html").read_text(encoding="utf-8").replace(
        "&#x27;", "'"
    )


def test_a_page_has_no_block_of_another_run_beside_it(run: Run, folder: Path) -> None:
    """A block that is not safe takes the file of an earlier, safe one away; and says what to do."""
    (folder / "spec.toml").write_text(QUICK, encoding="utf-8")
    assert run("observer", "spec.toml", "-o", "out").code == 0
    assert (folder / "out" / "controller.json").exists()
    steep = QUICK.replace('kind = "scaled"\nfactor = 0.7', 'kind = "none"')
    (folder / "spec.toml").write_text(steep, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
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


def test_poles_are_told_of_the_block_apart_from_those_of_its_design(
    answered: Callable[[str, str], Path],
) -> None:
    out = answered("repaired", QUICK)
    page = (out / "report.html").read_text(encoding="utf-8")
    block = hyst.load(out / "controller.json")
    fastest = np.abs(np.log(np.linalg.eigvals(block.A).astype(complex))).max() / block.dt
    # Four digits are told.
    assert f"{fastest / (2.0 * np.pi):.4g} Hz; half the sample rate" in page
    assert "continuous design: Q(s) denominator" in page


def test_what_is_to_be_implemented_is_what_was_simulated(
    answered: Callable[[str, str], Path],
) -> None:
    out = answered("repaired", QUICK)
    block = hyst.load(out / "controller.json")
    assert block.dt == 1e-4
    signals = hyst.read_record(out / "signals.csv", input="y_ref", output="y", time="time [s]")
    u = hyst.io.read_column(out / "signals.csv", "u")[0]
    # Noise-free: the recorded output, given to the block again, makes the recorded drive.
    again, _ = block.run(signals.u, signals.y)
    assert np.abs(again - u).max() < 1e-9 * np.abs(u).max()


def test_the_printed_example_is_refused_in_words(answered: Callable[[str, str], Path]) -> None:
    out = answered("printed", PRINTED)
    assert not (out / "controller.json").exists()
    told = json.loads((out / "certificate.json").read_text(encoding="utf-8"))
    assert told["safe"] is False
    assert told["verdict"].startswith("NOT SAFE")
    assert "UNSTABLE" in told["verdict"]
    # The notes on the paper: not below 2.126.
    assert told["gamma"] == pytest.approx(2.126, abs=2e-3)
    assert told["tracking"]["exact"]["without"]["rms"] is None


def test_a_true_plant_beyond_wu_is_told(answered: Callable[[str, str], Path]) -> None:
    told = json.loads((answered("repaired", QUICK) / "certificate.json").read_text("utf-8"))
    # Wu of the template is P / Pn - 1 of its true plant.
    assert abs(told["uncertainty_used"][0] - 1.0) < 1e-6
    assert "BUT" not in told["verdict"]
    # A tenth more gain is 0.1 off at rest, where Wu is 0.
    stronger = QUICK.replace("num = [1841905051748.9004]", "num = [2026095556923.79]")
    told = json.loads((answered("stronger", stronger) / "certificate.json").read_text("utf-8"))
    assert told["uncertainty_used"][0] > 2.0
    assert "the true plant is not within Wu: widen Wu" in told["verdict"]


def test_bounded_is_not_safe(answered: Callable[[str, str], Path]) -> None:
    """Without an inverse the loop stays bounded, but its plays are too steep for it."""
    text = QUICK.replace('kind = "scaled"\nfactor = 0.7', 'kind = "none"')
    assert text != QUICK
    told = json.loads((answered("none", text) / "certificate.json").read_text(encoding="utf-8"))
    assert told["safe"] is False
    assert told["tracking"]["none"]["with_observer"]["rms"] < 5.0
    # An eigenvalue computation by hand gives 1.35 to 1.4 for the true plant, which is at the edge
    # of Wu; of 40 slopes up to 3.4 the next above is at most 0.1 more.
    assert 1.2 < told["failing_slope"] < 1.5
    assert told["seen_slopes"][1] > 3.0
    assert told["tracking"]["none"]["with_observer"]["standing"] == "not safe"


# A stage at 200 Hz whose observer was called safe in continuous time: sampled, it is not.
FAST = """
[plant]
num = [1579136.7]
den = [1.0, 75.398, 1579136.7]
[controller]
num = [20.0]
den = [1.0, 0.0]
[weights]
Wu = { num = [3.9789e-4, 0.02], den = [3.9789e-5, 1.0] }
Wp = { num = [0.5, 94.25], den = [1.0, 0.1] }
[internal_model]
kind = "integrator"
[hysteresis]
p0 = 0.6
p = [0.12, 0.09, 0.08, 0.06, 0.05]
r = [0.5, 1.5, 3.0, 5.0, 8.0]
[inverse]
kind = "reduced"
plays = 2
reach = 10.0
[reference]
sines = [[8.0, 3.0]]
duration = 1.0
[simulation]
settle = 0.5
noise = 0.01
[filter]
dt = 1e-4
"""


def test_what_is_called_safe_was_searched_for_plants_that_break_it(run: Run, folder: Path) -> None:
    (folder / "spec.toml").write_text(FAST, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out", "--stress", "60")
    assert ended.code == 0
    told = json.loads((folder / "out" / "certificate.json").read_text(encoding="utf-8"))
    assert told["stress"]["tried"] == 60
    # Certificate and search must agree; which it is depends on the design.
    assert told["safe"] is (told["sampled"]["uncertainty_norm"] < 1.0)
    assert told["safe"] is (told["stress"]["broken"] == 0)
    assert (folder / "out" / "controller.json").exists() is told["safe"]
    assert "noise of 0.01" in ended.out


def change(old: str, new: str) -> str:
    assert old in TEMPLATE
    return TEMPLATE.replace(old, new)


MISTAKES = {
    "[plant] has an unknown entry 'denn'; did you mean 'den'": change(
        "[plant]", "[plant]\ndenn = [1.0]\n#"
    ),
    "unknown entry 'plants'; did you mean 'plant'": change("[true_plant]", "[plants]"),
    "the spec has no [controller]": change("[controller]", "[other]"),
    "[inverse] kind is 'half'": change('kind = "scaled"', 'kind = "half"'),
    "[inverse] has an unknown entry 'factor'": change('kind = "scaled"', 'kind = "exact"'),
    "[inverse] has no 'plays'": change('kind = "scaled"', 'kind = "reduced"'),
    "[inverse] factor is 0": change("factor = 0.7", "factor = 0.0"),
    "[simulation] dt is 'fast'": change("settle = 1.0", 'dt = "fast"\nsettle = 1.0'),
    "[simulation] dt is nan": change("settle = 1.0", "dt = nan\nsettle = 1.0"),
    "[filter] delay is -1e-05": change("delay = 0.0", "delay = -1e-5"),
    "settle is 5 s of 3 s": change("settle = 1.0", "settle = 5.0"),
    "noise is -1": change("noise = 0.0", "noise = -1.0"),
    "[simulation] seed is -3": change("seed = 0", "seed = -3"),
    "[reference] duration is 3 s, 0 samples of 20 s": change("dt = 1e-4", "dt = 20.0"),
    "[filter] dt is 2.5 s, and 2 s are measured": change("dt = 1e-4", "dt = 2.5").replace(
        "settle = 1.0", "dt = 0.01\nsettle = 1.0"
    ),
    "[filter] dt is 0": change("dt = 1e-4", "dt = 0.0"),
    "[filter] method is 'euler'": change('method = "tustin"', 'method = "euler"'),
    "[weights] Wu has num": change(
        "Wu = { num = [-1.0, -960.0, 0.0], den", "Wu = { num = [1.0], d"
    ),
    "[weights] Wp num is": change("Wp = { num = [0.5", 'Wp = { num = ["a"'),
    "[reference] sines has [18.0, 1.0, 2.0, 3.0]": change(
        "[[18.0, 1.0], [28.0, 3.0]]", "[[18.0, 1.0, 2.0, 3.0]]"
    ),
    "[reference] duration is 1e+07 s": change("duration = 3.0", "duration = 1e7"),
    "[internal_model] kind is 'sine'": change('"integrator"\n', '"sine"\n'),
    "[reference] sines has 5000 Hz, and half the sample rate is 5000 Hz": change(
        "[28.0, 3.0]", "[28.0, 5000.0]"
    ),
    "[internal_model] sinusoids has 6000 Hz": change("# sinusoids = [50.0]", "sinusoids = [6e3]"),
    "[weights] has no 'Wp'": change("Wp = {", "# Wp = {"),
    "order is 'full'; give a whole number or \"auto\"": change(
        "# [design]  # optional", '[design]\norder = "full"'
    ),
    "[internal_model] sinusoids is -50": change("# sinusoids = [50.0]", "sinusoids = [-50.0]"),
    "p has 9 entries but r has 10": change("1.1, 1.7]", "1.1]"),
    "p0 is -0.1": change("p0 = 0.1", "p0 = -0.1"),
    "is no TOML file": change("[plant]", "[plant"),
    "[controller] is improper": change("num = [4.0, 8.0]", "num = [4.0, 8.0, 1.0]"),
}


@pytest.mark.parametrize("said", MISTAKES)
def test_mistakes_in_a_spec(said: str, folder: Path, refused: Callable[..., str]) -> None:
    (folder / "spec.toml").write_text(MISTAKES[said], encoding="utf-8")
    message = refused("observer", "spec.toml", "-o", "out")
    assert said in message
    assert "spec.toml" in message


def test_other_mistakes(folder: Path, refused: Callable[..., str]) -> None:
    assert "no such file" in refused("observer", "nothing.toml", "-o", "out")
    assert "--template" in refused("observer")
    assert "--template" in refused("observer", "--template", "-o", "out")
    (folder / "model.toml").write_text(change("p0 = 0.1", 'file = "model.json"'), encoding="utf-8")
    assert "unknown entry" in refused("observer", "model.toml", "-o", "out")
    (folder / "folder.toml").mkdir()
    assert "is a folder" in refused("observer", "folder.toml", "-o", "out")


def test_a_plant_that_cannot_be_observed_is_refused(
    folder: Path, refused: Callable[..., str]
) -> None:
    text = change("den = [1.0, 904.7786842338605, 319775.1825952952]", "den = [1.0, 0.0, -4.0]")
    (folder / "spec.toml").write_text(text, encoding="utf-8")
    assert "plant" in refused("observer", "spec.toml", "-o", "out")


def test_a_model_file_other_forms_of_systems_and_a_reduced_inverse(run: Run, folder: Path) -> None:
    model = hyst.GeneralizedPrandtlIshlinskii(
        hyst.DeadZone.odd([0.65, 0.2], [0.0, 7.56]), hyst.PrandtlIshlinskii([0.5, 0.5], [1, 2], 0.5)
    )
    about = hyst.operators.ModelDescription(input_low=-2.0, input_high=3.0, dt=0.001, delay=4)
    model.save(folder / "model.json", about)
    hyst.io.write_columns(
        folder / "wanted.csv", ["y_ref"], [10.0 * np.sin(np.linspace(0.0, 20.0, 6000))]
    )
    spec = """
        [plant]
        zeros = []
        poles = [[-50.0, 20.0]]
        gain = 2900.0
        [controller]
        A = [[0.0]]
        B = [1.0]
        C = [20.0]
        D = [[1.0]]
        [weights]
        Wu = { num = [0.4, 0.0], den = [1.0, 400.0] }
        Wp = { num = [0.3, 3.0], den = [1.0, 0.1] }
        [internal_model]
        A = [[0.0]]
        C = [1.0]
        [hysteresis]
        file = "model.json"
        [inverse]
        kind = "reduced"
        plays = 1
        reach = 12.0
        [reference]
        file = "wanted.csv"
        column = "y_ref"
        [simulation]
        dt = 1e-3
        [filter]
        dt = 1e-3
    """
    (folder / "spec.toml").write_text(spec, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
    assert ended.code == 0, ended
    told = json.loads((folder / "out" / "certificate.json").read_text(encoding="utf-8"))
    assert told["inverse"] == "1 play"
    assert told["identified"] == [-2.0, 3.0]
    assert told["inverse_error_bound"]["bound"] >= told["inverse_error_bound"]["reached"] > 0.0
    assert "1 play" in ended.out
    # The plays need a drive near 10 for an output of 10: far beyond what the file says it knows.
    u = np.loadtxt(folder / "out" / "signals.csv", delimiter=",", skiprows=1)[:, 3]
    assert told["drive_range"][0] <= u.min() < -2.5
    assert told["drive_range"][1] >= u.max() > 3.5
    assert "identified from -2 to 3: beyond, all of this is a guess" in told["verdict"]
    assert "lagged the model by 4 samples, 4 ms: put that lag into plant or Wu" in ended.err


def test_without_the_solvers_the_descent_alone_designs(
    run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    design = hyst.control.design_disturbance_observer

    def without_solvers(*given: Any, method: str, **options: Any) -> Any:
        asked.append(method)
        if "slpmm" in method:
            raise hyst.MissingExtraError("cvxpy is not installed; pip install hyst[control]")
        return design(*given, method=method, **options)

    monkeypatch.setattr(hyst.control, "design_disturbance_observer", without_solvers)
    (folder / "spec.toml").write_text(QUICK, encoding="utf-8")
    ended = run("observer", "spec.toml", "-o", "out")
    assert ended.code == 0
    assert asked == ["slpmm+descent", "descent"]
    assert "note: cvxpy is not installed" in ended.err


def test_other_observers_of_the_spec(run: Run, folder: Path) -> None:
    """The classical filter, no observer, and a design in discrete time: each block is safe here."""
    quick = FAST.replace("duration = 1.0", "duration = 0.6").replace("settle = 0.5", "settle = 0.3")
    told = {}
    for name, asked in {
        "q-filter": 'observer = "q-filter"\norder = 3',
        "none": 'observer = "none"',
        "discrete": 'time = "discrete"\norder = "auto"',
    }.items():
        (folder / "spec.toml").write_text(f"{quick}[design]\n{asked}\n", encoding="utf-8")
        ended = run("observer", "spec.toml", "-o", name, "--stress", "30")
        assert ended.code == 0, ended
        told[name] = json.loads((folder / name / "certificate.json").read_text(encoding="utf-8"))
        assert told[name]["safe"] is True
        assert told[name]["stress"]["broken"] == 0
        assert hyst.load(folder / name / "controller.json").dt == 1e-4
    # Integral control alone has one state; the classical filter three lags and the plant's two.
    assert hyst.load(folder / "none" / "controller.json").order == 1
    tracked = {name: each["tracking"]["2 plays"] for name, each in told.items()}
    assert tracked["none"]["without"] == tracked["none"]["with_observer"]
    assert told["none"]["sampled"]["rejection_bandwidth"] == 0.0
    for name in ("q-filter", "discrete"):
        assert told[name]["sampled"]["performance_norm"] < 1.0
        assert tracked[name]["with_observer"]["rms"] < tracked["none"]["without"]["rms"]


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ('[design]\nobserver = "kalman"', "[design] observer is 'kalman'"),
        ('[design]\ntime = "soon"', "[design] time is 'soon'"),
        ("[design]\norder = -1", "[design] order is -1"),
        ('[design]\nobserver = "none"\norder = 4', "[design] has an unknown entry 'order'"),
        ("[limits]\ndrive = [3.0, -3.0]", "[limits] drive is [3.0, -3.0]"),
        ("[limits]\nrate = 0.0", "[limits] rate is 0"),
    ],
)
def test_mistakes_in_what_is_optional(
    asked: str, says: str, folder: Path, refused: Callable[..., str]
) -> None:
    (folder / "spec.toml").write_text(f"{FAST}{asked}\n", encoding="utf-8")
    assert says in refused("observer", "spec.toml", "-o", "out")


def test_limits_of_the_spec_are_kept_and_nothing_is_proven_at_them(run: Run, folder: Path) -> None:
    (folder / "spec.toml").write_text(f"{FAST}[limits]\ndrive = [-4.0, 4.0]\n", encoding="utf-8")
    assert run("observer", "spec.toml", "-o", "out").code == 0
    told = json.loads((folder / "out" / "certificate.json").read_text(encoding="utf-8"))
    assert told["drive_range"][0] == -4.0
    assert told["drive_range"][1] == 4.0
    row = told["tracking"]["2 plays"]["with_observer"]
    assert row["standing"] == "simulated"
    assert "limits" in row["reason"]
