"""The study of S3: what it shows and prints, against the paper and against arithmetic."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hyst import InputError
from hyst.cli import main
from hyst.report.table import Table
from hyst.studies import keys, s3_memory_elements, study
from hyst.studies.simulated_piezo import DT, SimulatedPiezo


@pytest.fixture(scope="module")
def tables() -> tuple[Table, ...]:
    return s3_memory_elements.tables()


def row(table: Table, name: str) -> tuple[str, ...]:
    return next(each for each in table.rows if each[0].startswith(name))


def test_only_nested_loops_close(tables: tuple[Table, ...]) -> None:
    # Sums of a few hundred numbers of 1000 nm for the one; some 200 nm a cycle for the other.
    assert float(row(tables[0], "masing")[2]) < 1e-10
    assert float(row(tables[0], "last-reversal")[2]) > 100.0
    # Example 1 alone has no loop inside a loop that would tell them apart.
    assert float(row(tables[0], "last-reversal")[1]) < 1e-10


def test_feedforward_against_the_paper(tables: tuple[Table, ...]) -> None:
    names = ("linear", "Prandtl", "memory")
    linear, pi, element = (row(tables[1], name) for name in names)
    assert (linear[-1], pi[-1], element[-1]) == ("339.3", "97.5", "27.9")
    assert int(element[1]) == 3
    assert int(pi[1]) == 31
    for place in range(2, 5):
        # As on the paper's actuator, a power law leaves about a tenth of what a line leaves.
        assert float(element[place]) < 0.15 * float(linear[place])
        # Its factor of 3.5 over plays is not: plays that are fitted well do as well or better.
        assert float(pi[place]) < 1.1 * float(element[place])


@pytest.mark.parametrize(("asymmetric", "creeps"), [(False, False), (True, True)])
def test_the_simulated_piezo_is_its_differential_equations(asymmetric: bool, creeps: bool) -> None:
    t = np.arange(0.0, 0.05, DT)
    volts = np.concatenate([[0.0], 120.0 * np.sin(100.0 * t) + 90.0 * np.sin(310.0 * t)])
    w, e = 2.0 * np.pi * 2000.0, 6e-4 * asymmetric
    lags, share = np.array([0.05, 0.5, 5.0]), 0.015 * creeps

    def slope(time: float, state: np.ndarray, u: float, du: float) -> np.ndarray:
        z, position, speed, *late = state
        v = u + du * time
        dz = (4.0 - 0.006 * np.sign(du) * z - 0.002 * abs(z)) * du
        y = 8.2 * v + e * v**2 - z
        force = y + share * sum(late)
        return np.array(
            [dz, speed, w * w * (force - position) - 0.1 * w * speed, *((y - late) / lags)]
        )

    state, expected = np.zeros(6), []
    for last, now in zip(volts[:-1].tolist(), volts[1:].tolist(), strict=True):
        of = (last, (now - last) / DT)
        solved = solve_ivp(slope, (0.0, DT), state, args=of, rtol=1e-9, atol=1e-9)
        state = solved.y[:, -1]
        expected.append(state[1])
    y = SimulatedPiezo(asymmetric, creeps)(volts[1:])
    # Lags rest between twentieths of a sample: 25 us of their 15 nm per 50 ms, some 1e-4 of y.
    assert np.abs(y - expected).max() < 1e-4 * np.ptp(y)


def test_the_simulated_piezo_is_none_of_the_models() -> None:
    u = 250.0 * np.sin(np.linspace(0.0, 4.0 * np.pi, 4001))
    plain, bent, both = (plant(u) for plant in s3_memory_elements.PLANTS.values())
    assert np.ptp(plain) == pytest.approx(3200.0, rel=0.01)
    # Noise of the scatter of a measured piezo; 4000 samples tell it to 1 %.
    noise = SimulatedPiezo().measure(u) - both
    assert np.std(noise) == pytest.approx(0.0019 * np.ptp(both), rel=0.05)
    # A symmetric loop is its own image in its centre; creep leaves the start above the end.
    images = [np.abs(y[2000:3000] + y[3000:4000]) for y in (plain, bent)]
    assert images[0].max() < 0.001 * np.ptp(plain)
    assert images[1].max() > 0.01 * np.ptp(bent)
    hold = np.concatenate([u[:1001], np.full(2000, 250.0)])
    after = [plant(hold)[-1] - plant(hold)[1050] for plant in s3_memory_elements.PLANTS.values()]
    assert np.abs(after[:2]).max() < 1e-3
    assert after[2] > 20.0


def test_figures_are_drawn() -> None:
    for name, content in s3_memory_elements.figures().items():
        assert name.endswith(".png")
        assert content.startswith(b"\x89PNG")


def test_the_verb_prints_the_paper_beside_ours(capsys, tmp_path) -> None:
    assert main(["reproduce", "s3", "-o", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    for number in ("339.3", "97.5", "27.9"):
        assert number in printed
    assert (tmp_path / "out" / "s3-slopes.png").stat().st_size > 0


def test_unknown_studies_are_refused(capsys) -> None:
    assert "s3" in keys()
    with pytest.raises(InputError, match="s3"):
        study("s9")
    assert main(["reproduce", "s9"]) == 2
    assert "s9" in capsys.readouterr().err
