"""The study of S2 against code of its own: the printed law, the bound, and printed constants."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

import hyst
from hyst.cli import main
from hyst.studies import s2_adaptive_radii as s2
from hyst.studies.s2_adaptive_radii import (
    against_fixed,
    measured_piezo,
    over_bound,
    paper,
    printed_law,
)
from hyst.studies.simulated_piezo import DT, SimulatedPiezo

Array = NDArray[np.float64]

P = np.array([0.3, 0.5, 0.8, 0.3, 0.2])
R = np.array([0.4, 1.0, 1.5, 2.0, 3.6])


def plays(u: Array, r: Array) -> Array:
    """Play operators by eqs. 1 and 2, a column each."""
    z, found = np.zeros(r.size), np.empty((u.size, r.size))
    for k, v in enumerate(u):
        z = np.maximum(v - r, np.minimum(v + r, z))
        found[k] = z
    return found


def regression(u: Array, own_reversals: bool) -> tuple[Array, Array]:
    """Rows phi and numbers b of ``y = phi r + b`` as eq. 17 has them, with the true regimes.

    An interior play is at ``v(t_k-1) + s r``, t_k-1 being the last reversal, or where it left its
    own envelope."""
    z = plays(u, R)
    s = np.sign(np.diff(u, prepend=u[0]))
    on = s[:, None] * (u[:, None] - z) >= R - 1e-9
    phi, b = np.zeros(z.shape), np.zeros(u.size)
    last, home, side, direction = u[0], np.zeros(5), np.zeros(5), 0.0
    seen = np.zeros(5, dtype=bool)
    for k in range(1, u.size):
        if s[k] != direction:
            last, direction = u[k - 1], s[k]
            home[seen], side[seen] = last, direction
            seen[:] = False
        seen |= on[k]
        inside = (home, side) if own_reversals else (np.full(5, last), np.full(5, direction))
        phi[k] = P * np.where(on[k], -s[k], inside[1])
        b[k] = P @ np.where(on[k], u[k], inside[0])
    return phi[1:], b[1:]


def by_gradient(phi: Array, target: Array, r: Array, passes: int) -> Array:
    """``dr/dt = 10 phi e``, a period again and again; the radii stay in order where it is used."""
    for _ in range(passes):
        for row, out in zip(phi, target, strict=True):
            r = r + 10.0 * paper.DT * row * (out - row @ r)
    return r


def test_the_printed_law_misses_where_remark_3_says_it_converges() -> None:
    # 30 sin x + 6 sin 9x: periodic, a range of 70 where 7.2 suffice, reversals in each period.
    u = printed_law.nested(6.0, 9.0, 3.0)
    y = plays(u, R) @ P
    last = slice(2000, 3000)  # a settled period
    found = {}
    for own in (False, True):
        phi, b = (each[1999:2999] for each in regression(u, own))
        found[own] = by_gradient(phi, y[last] - b, R.copy(), 40)
    # The same 41 % of r_1 as the study; it starts elsewhere and repeats one period: 1e-3 of 0.56.
    rows = printed_law.remark_3().rows
    studied = np.array([float(each) for each in rows[0][2:7]])
    assert studied == pytest.approx(found[False], abs=1e-3)
    assert abs(studied[0] / R[0] - 1.0) > 0.38
    # With the reversal of each play the truth is where the law rests, and where it goes to.
    assert found[True] == pytest.approx(R, abs=1e-9)
    assert [float(each) for each in rows[2][2:7]] == pytest.approx(R.tolist(), abs=2e-3)
    # The other reading converges there, but not from 1.5 times the radii with 5 loops a period.
    assert float(rows[1][7]) < 0.01
    assert float(rows[4][7]) > 10.0
    # The law with each play's own reversal is still under way there, at 2 % after 100 s.
    assert float(rows[5][7]) < 3.0


@pytest.mark.parametrize("name", ["sine", "staircase"])
def test_errors_are_told_over_the_bound_for_both_inputs(name: str) -> None:
    rows = {
        row[0]: [float(each) for each in row[1:]] for row in over_bound.errors_over_bound(name).rows
    }
    for decibels in ("10 dB", "20 dB"):
        # What is asked of the joint estimator after 100 s; the law is reported, whatever it gives.
        assert rows[f"joint, {decibels}"][-1] < 1.5
        # Its error does not fall as the bound does, so it gets farther from it.
        law = rows[f"paper, {decibels}"]
        assert law == sorted(law)
        assert law[-1] > 3.0
        # With the slope from before the noise: 1.4 and 2.3 by code written from the paper alone,
        # for the sine; 6 runs of 5 radii scatter by some 15 %.
        told = rows[f"paper told slopes, {decibels}"]
        assert 1.1 < told[-1] < 2.7
    # Ten decibels are a factor of sqrt(10) in the noise, and so in the bound; 3 digits are told.
    bounds = np.array([rows[f"largest bound, {each} dB"] for each in (10, 20)])
    assert bounds[0] / bounds[1] == pytest.approx(np.full(4, np.sqrt(10.0)), rel=0.01)
    # As many samples of each kind in each period: the bound falls with the root of time, from 20 s
    # on, where the first stroke, which differs, is 1 of 20 strokes or less.
    assert bounds[0, 1] / bounds[0, 3] == pytest.approx(np.sqrt(5.0), rel=0.05)


def test_bounds_of_the_radii_alone_are_those_of_the_regression() -> None:
    u = paper.sine(20.0)
    phi, _ = regression(u, own_reversals=True)
    alone, _ = over_bound.bounds(u, 2.0)
    # Both have the derivative of the output by the radii; at the first sample nothing has moved.
    expected = 2.0 * np.sqrt(np.diag(np.linalg.inv(phi.T @ phi)))
    assert alone[1] == pytest.approx(expected, rel=1e-3)


def test_printed_constants_of_the_experiment() -> None:
    rows = {row[0]: row[1:] for row in measured_piezo.constants().rows}
    # Slopes 6.3460, 8.0195, 9.1747, 9.6224 by hand.
    assert rows["weights: differences of the slopes"][1] == "6.3460 1.6735 1.1552 0.4477"
    # Segmentation and the law find what the simulated piezo was made of.
    assert rows["the same by segmentation (lemma 1)"][1] == "6.3460 1.6735 1.1552 0.4477"
    assert rows["radii by the law, gain 20, 60 s, from 0"][1] == "0.1945 0.4826 0.5707"
    # sum of p (2 - 2 r) on 2 V, and 2 sum(p r) / sum(p) = 2 * 1.1384 / 9.6224.
    weights, radii = (
        np.array([6.3460, 1.6735, 1.1552, 0.4477]),
        np.array([0, 0.1945, 0.4826, 0.5707]),
    )
    assert rows["range of the output, 2 V [um]"][1] == f"{weights @ (2.0 - 2.0 * radii):.4g}"
    width = 2.0 * (weights @ radii) / weights.sum()
    assert rows["loop width 2 sum(p r) / sum(p) [V]"][1] == f"{width:.4g}"
    assert rows["range that suffices by eq. 26 [V]"][1] == f"{width * weights.sum() / 0.4477:.4g}"


def test_printed_seven_plays_are_no_fit() -> None:
    rows = {row[0]: row[1:] for row in measured_piezo.refits().rows}
    seven = [float(each) for each in rows["printed, n = 7"][:3]]
    # Range by hand: sum of p (2 - 2 r) with r = 0, 1/6, .. 1.
    printed = np.array([5.4194, 2.2159, 1.2423, 0.0852, 0.3505, 0.0145, 0.0099])
    assert seven[0] == pytest.approx(printed @ (2.0 - np.arange(7) / 3.0), abs=5e-3)
    # 0.228 and 0.405 by code of somebody else; the minor loops are not the paper's.
    assert seven[1] == pytest.approx(0.228, abs=1e-3)
    assert seven[2] == pytest.approx(0.405, abs=5e-3)
    for n in range(5, 11):
        refit = [float(each) for each in rows[f"least squares, n = {n}"][1:3]]
        assert refit[0] < 0.5 * seven[1]
        assert refit[1] < 0.5 * seven[2]


@pytest.mark.parametrize("n", [4, 7, 10])
def test_refits_are_least_squares(n: int) -> None:
    u = measured_piezo.drive(measured_piezo.MAJOR)
    four = plays(u, np.array([0.1945, 0.4826, 0.5707])) @ [1.6735, 1.1552, 0.4477] + 6.3460 * u
    matrix = np.column_stack([plays(u, np.arange(n) / (n - 1.0)), np.ones(u.size)])[1000:]
    # Weights of at least 0 and a free offset by another solver.
    least = np.append(np.zeros(n), -np.inf)
    found = lsq_linear(matrix, four[1000:], (least, np.full(n + 1, np.inf)), tol=1e-14)
    model = measured_piezo.refit(n)
    error = (model(u) - four)[1000:]
    square = float(np.sum((error - error.mean()) ** 2))
    # The weight of the last play, which does not move, is free; its square error is not.
    assert square == pytest.approx(2.0 * found.cost, rel=1e-6)


def test_no_direction_leads_off_zero_by_the_printed_projection() -> None:
    # Condition (c) of eq. 23 at r = 0: -dr_1 < 0 and dr_i - dr_i+1 < 0 with dr = gain e phi.
    ways = 0
    for on in range(6):
        for sign in (1.0, -1.0):
            dr = sign * np.where(np.arange(5) < on, P, -P)
            ways += bool(dr[0] > 0.0 and (dr[:-1] < dr[1:]).all())
    rows = {row[0]: row[2] for row in s2.errata().rows}
    assert ways == 0
    assert rows["eq. 23, several boundaries"].startswith("0 of 12 ")


def test_errata_name_each_place() -> None:
    places = " ".join(row[0] for row in s2.errata().rows)
    for place in ("eq. 17, row 3", "eq. 21", "eq. 23", "fig. 2", "remark 3", "prop. 2", "sec. V-C"):
        assert place in places


def test_the_comparison_runs_on_any_record(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plant = SimulatedPiezo(asymmetric=False, creeps=False)
    files = []
    for name, corners in (
        ("major", [0.0, *([200.0, -200.0] * 3)]),
        ("minor", [0.0, 150.0, -150.0, 100.0, -50.0, 150.0, -150.0]),
    ):
        u = paper.triangle(corners, 0.5)
        files.append(str(tmp_path / f"{name}.csv"))
        hyst.io.write_columns(Path(files[-1]), ["u", "y"], (u, plant.measure(u)))
    columns = ["--input", "u", "--output", "y", "--rate", f"{1.0 / DT:g}"]
    told = ["reproduce", "s2", "--record", files[0], "--validate", files[1], "--delay", "0"]
    assert main([*told, *columns]) == 0
    shown = capsys.readouterr().out
    for label in ("slopes by segmentation", "by the paper's law", "n = 4", "n = 10", "validation"):
        assert label in shown
    assert main(["reproduce", "s2", "--record", files[0], "--input", "u"]) == 2
    assert "--record needs --output" in capsys.readouterr().err
    assert main(["reproduce", "s3", "--record", files[0], *columns]) == 2
    assert "s3 has no comparison for --record; choose s2" in capsys.readouterr().err
    assert main(["reproduce", "s2", "--delay", "1"]) == 2
    assert "--delay is about a record" in capsys.readouterr().err


def test_a_preassigned_model_leaves_what_least_squares_leaves() -> None:
    rng = np.random.default_rng(3)
    u = paper.triangle([0.0, *([8.0, -8.0] * 3)], 0.02)
    y = 0.5 * u + plays(u, np.array([1.0, 2.0, 5.0])) @ [0.4, 0.2, 0.3]
    record = hyst.Record(u, y + rng.normal(0.0, 0.01, u.size), 0.01)
    (table,) = against_fixed.on_record(record, delay=0, counts=(5,))
    rows = {row[0]: float(row[2]) for row in table.rows}
    # Radii 0, 2, 4, 6, 8, of which the last does not move; all weights are positive here.
    start = against_fixed.settled(u)
    matrix = np.column_stack([u, np.ones(u.size), plays(u, np.array([2.0, 4.0, 6.0]))])[start:]
    weights = np.linalg.lstsq(matrix, record.y[start:], rcond=None)[0]
    assert (weights[[0, 2, 3, 4]] > 0.0).all()
    assert rows["preassigned radii, n = 5"] == pytest.approx(
        float(np.std(record.y[start:] - matrix @ weights)), rel=1e-3
    )
    # Three plays and the input made it, so estimated radii leave the noise; 2 % for 4000 samples.
    assert rows["all by hyst identify"] == pytest.approx(0.01, rel=0.05)


def test_bad_requests_are_refused() -> None:
    u = paper.triangle([0.0, *([8.0, -8.0] * 3)], 0.02)
    record = hyst.Record(u, u, 0.01)
    with pytest.raises(hyst.InputError, match="a count of plays is 1"):
        against_fixed.on_record(record, counts=(1,))
    with pytest.raises(hyst.InputError, match=r"dt = 0\.02 s and the other one 0\.01 s"):
        against_fixed.on_record(record, hyst.Record(u, u, 0.02))
    with pytest.raises(hyst.InputError, match="delay is -1"):
        against_fixed.on_record(record, delay=-1)


def test_measured_piezo(measured_data: Path) -> None:
    path = measured_data / "piezo-dbo" / "Model_Vi_Do.dat"
    record = hyst.read_record(path, input="0", output="4", rate=200.0)
    (table,) = against_fixed.on_record(record, delay=1)
    rms = {row[0]: float(row[2]) for row in table.rows}
    # The paper's claim: four plays of estimated radii do better than more plays of fixed ones.
    assert rms["all by the joint estimator"] < rms["preassigned radii, n = 7"]
    assert rms["slopes by segmentation"] < rms["preassigned radii, n = 4"]
    # By the paper's law they do worse than before it, for a piezo is no such model.
    assert rms["and radii by the paper's law"] > rms["slopes by segmentation"]


def test_figures_for_the_page_are_drawn_and_small() -> None:
    drawn = s2.figures()
    pages = {
        "s2_trajectories.png": "online.md",
        "s2_over_bound.png": "online.md",
        "s2_remark_3.png": "s2_adaptive_radii.md",
    }
    for name, page in pages.items():
        assert drawn[name].startswith(b"\x89PNG")
        assert len(drawn[name]) < 120_000
        # The page shows what the command draws.
        docs = Path(__file__).resolve().parents[2] / "docs"
        assert (docs / "figures" / name.replace("_", "-")).exists()
        assert name.replace("_", "-") in (docs / page).read_text(encoding="utf-8")
