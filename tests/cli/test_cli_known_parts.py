"""hyst identify with dynamics or hysteresis that are known, from files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv

import hyst
from hyst.models import LinearDynamics

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

DT = 1e-4
W = 2.0 * np.pi * 200.0
G = LinearDynamics.from_continuous([W * W], [1.0, 0.06 * W, W * W], DT, 3)
FRONT = hyst.PrandtlIshlinskii([0.3, 0.2], [1.5, 4.0], 1.0)
T = np.arange(4000) * DT
U = 20.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * 10.0 * T))
F = np.linspace(1.0, 1000.0, 100)
KIND = ("--family", "hammerstein", "--input", "u", "--output", "y", "--time", "t")
PI = ("--hysteresis", "pi", "--plays", "2")


@pytest.fixture
def files(folder: Path) -> Path:
    y = (G @ FRONT)(U)
    y += 0.01 * y.std() * np.random.default_rng(0).normal(size=y.size)
    write_csv(folder / "loop.csv", "t,u,y", T, U, y)
    G.save(folder / "G.json")
    FRONT.save(folder / "front.json")
    H = -20.0 * G.frequency_response(F)
    polar = (F, 20.0 * np.log10(np.abs(H)), np.rad2deg(np.unwrap(np.angle(H))))
    write_csv(folder / "polar.csv", "frequency [Hz],magnitude [dB],phase [deg]", *polar)
    write_csv(folder / "parts.csv", "omega [rad/s],real,imaginary", 2e0 * np.pi * F, H.real, H.imag)
    write_csv(folder / "bare.csv", "f,mag,phase [rad]", F, np.abs(H), np.angle(H))
    banded = "frequency [Hz],gain,gain low,gain high,phase [deg],phase low [deg],excited"
    gain, phase = np.abs(H), np.rad2deg(np.unwrap(np.angle(H)))
    bands = (gain, 0.5 * gain, 2.0 * gain, phase, phase - 90.0, np.ones(F.size))
    write_csv(folder / "banded.csv", banded, F, *bands)
    return folder


@pytest.mark.parametrize("name", ["G.json", "polar.csv", "parts.csv", "bare.csv", "banded.csv"])
def test_known_dynamics_come_from_a_file(run: Run, files: Path, name: str) -> None:
    ended = run("identify", files / "loop.csv", *KIND, *PI, "--dynamics", files / name, "-o", "out")
    assert ended.code == 0, ended.err
    assert "the dynamics were given and are held" in ended.out
    numbers = json.loads((Path(files) / "out" / "metrics.json").read_text())
    assert numbers["dynamics"]["given"] is True
    clean = (G @ FRONT)(U)
    model = hyst.load(files / "out" / "model.json")
    # 1 % noise over 4000 samples and six constants: some 0.04 %.
    assert (model(U) - clean)[3000:].std() < 2e-3 * clean.std()


def test_known_hysteresis_comes_from_a_file(run: Run, files: Path) -> None:
    known = ("--front", files / "front.json", "--dynamics", files / "G.json")
    ended = run("identify", files / "loop.csv", *KIND, *known, "-o", "out")
    assert ended.code == 0, ended.err
    assert "the hysteresis was given and is held" in ended.out
    assert "affine.gain" in ended.out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--dynamics", "loop.csv"), "--dynamics: loop.csv has no column of frequency, only t, u"),
        (("--dynamics", "no.json"), "--dynamics: no.json: cannot be read"),
        (("--dynamics", "front.json"), "--dynamics is a prandtl-ishlinskii at its output"),
        (("--front", "G.json"), "--front is linear-dynamics without a hysteresis"),
        (("--front", "front.json", *PI), "front is given, so hysteresis 'pi' and its options"),
    ],
)
def test_what_is_not_known_from_a_file_is_refused(
    run: Run, files: Path, arguments: tuple[str, ...], says: str
) -> None:
    ended = run("identify", files / "loop.csv", *KIND, *arguments, "-o", "out")
    assert ended.code != 0
    assert says in ended.err
    assert not (files / "out").exists()


def test_units_of_a_response_that_are_unknown_are_refused(files: Path) -> None:
    write_csv(files / "rpm.csv", "frequency [rpm],mag,phase", F, F, F)
    with pytest.raises(hyst.InputError, match="frequency is in 'rpm'; give it in one of hz, khz"):
        hyst.read_frequency_response(files / "rpm.csv")
    write_csv(files / "two.csv", "frequency,mag,magnitude,phase", F, F, F, F)
    with pytest.raises(hyst.InputError, match="has 2 columns of magnitude: mag, magnitude"):
        hyst.read_frequency_response(files / "two.csv")
    write_csv(files / "half.csv", "frequency,real", F, F)
    with pytest.raises(hyst.InputError, match="no column of magnitude and phase, or real and"):
        hyst.read_frequency_response(files / "half.csv")
