"""Records of several sample times: inputs held, outputs compared where they were measured."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hyst
from hyst.errors import InputError
from hyst.identification.families.hammerstein import IdentifiedHammerstein
from hyst.identification.record_use.one_sample_time import at_one_sample_time
from hyst.models import LinearDynamics
from hyst.signals import Record, multisine

DT, W, NOISE = 1e-3, 2.0 * np.pi * 60.0, 0.02
G = LinearDynamics.from_continuous([W * W], [1.0, 0.1 * W, W * W], DT, 1)
WEIGHTS, RADII, P0 = (0.12, 0.09, 0.08), (0.5, 1.5, 3.0), 0.6
PI = hyst.PrandtlIshlinskii(WEIGHTS, RADII, P0)
TRUE = {"p0": P0} | {f"p[{i}]": weight for i, weight in enumerate(WEIGHTS, 1)}


def fine(seed: int) -> Record:
    """Quick and small: it shows the resonance, and little of the widest play."""
    u = multisine(DT, 3000, amplitude=4.0, periods=2, seed=seed).u
    return Record(u, (G @ PI)(u) + NOISE * np.random.default_rng(seed).normal(size=u.size), DT)


def coarse(seed: int, n: int = 5) -> Record:
    """Slow and large: simulated at the fine sample time, recorded every n-th sample."""
    t = np.arange(12_000 // n) * n * DT
    u = 10.0 * np.sin(2.3 * t) * np.cos(0.3 * t + seed) + 1.5 * np.sin(18.2 * t)
    y = (G @ PI)(np.repeat(u, n))[::n]
    return Record(u, y + NOISE * np.random.default_rng(seed + 100).normal(size=u.size), n * DT)


def identified(records: Any, **options: Any) -> IdentifiedHammerstein:
    more = {"hysteresis": "pi", "radii": RADII} | options
    found = hyst.identify(records, family="hammerstein", **more)
    assert isinstance(found, IdentifiedHammerstein)
    return found


def constants(found: IdentifiedHammerstein) -> dict[str, tuple[float, float]]:
    names = [each.rpartition(".")[2] for each in found.parameter_names]
    pairs = zip(found.parameter_values, found.standard_errors, strict=True)
    return dict(zip(names, pairs, strict=True))


@pytest.mark.parametrize(("n", "order"), [(2, (0, 1)), (5, (1, 0)), (16, (0, 1))])
def test_a_fine_and_a_coarse_record_tell_more_than_one(n: int, order: tuple[int, int]) -> None:
    records = [fine(1), coarse(1, n)]
    both, alone = identified([records[i] for i in order]), identified(records[0])
    assert both.dynamics.dt == DT
    assert both.dynamics.order == 2
    for name, true in TRUE.items():
        value, error = constants(both)[name]
        assert abs(value - true) < 4.0 * error  # one run in some thousands fails
        assert error < 1.02 * constants(alone)[name][1]
    # The widest play hardly moves in the fine record.
    assert constants(both)["p[3]"][1] < 0.9 * constants(alone)["p[3]"][1]
    assert np.abs(np.sort_complex(both.poles) - np.sort_complex(G.poles())).max() < 1e-4
    said = f"sampled every {n * DT:.6g} s, was taken to 0.001 s: its input is held"
    assert any(said in each for each in both.undetermined)
    assert both.verdict.level == "good"


def test_radii_of_either_record_are_found() -> None:
    """The narrowest play moves in both, the widest hardly in the fine record."""
    found = identified([fine(1), coarse(1)], radii=None, plays=3)
    for i, radius in enumerate(RADII, 1):
        value, error = constants(found)[f"r[{i}]"]
        assert abs(value - radius) < 4.0 * error < 0.1
    # White noise over some 7000 samples is known to 0.8 %; three times that.
    assert found.noise_rms == pytest.approx(NOISE, rel=0.025)


def test_standard_errors_agree_with_scatter() -> None:
    held = LinearDynamics(G.A, G.B, G.C, G.D, DT, 1)
    runs = [
        constants(identified([coarse(seed), coarse(seed + 50, 4)], dynamics=held))["p[2]"]
        for seed in range(6)
    ]
    values, errors = np.array(runs).T
    # Six runs know their scatter to a third; about three times that to either side.
    ratio = (values - TRUE["p[2]"]) / errors
    assert 0.5 < np.sqrt(np.mean(ratio**2)) < 1.7


def test_coarse_records_alone_take_the_sample_time_of_known_dynamics() -> None:
    found = identified(coarse(3), dynamics=G)
    for name, true in TRUE.items():
        value, error = constants(found)[name]
        assert abs(value - true) < 4.0 * error
    with pytest.raises(InputError, match=r"sample time 0.001 s, the records 0.0025 s; give"):
        identified(Record(coarse(3).u, coarse(3).y, 2.5e-3), dynamics=G)


def test_bad_samples_of_a_coarse_record_do_not_count() -> None:
    clean = coarse(2)
    y = clean.y.copy()
    y[[700, 1200]] += 40.0
    bad, good = (constants(identified([fine(2), r])) for r in (Record(clean.u, y, clean.dt), clean))
    for name, (value, error) in good.items():
        assert abs(bad[name][0] - value) < 0.2 * error or not error > 0.0


def test_what_is_lifted_is_what_a_converter_gives() -> None:
    record = Record([1.0, 2.0, 0.0], [5.0, 8.0, 2.0], 0.3)
    other = Record([1.0, 2.0, 0.0], [1.0, 2.0, 3.0], 0.2)
    found = at_one_sample_time((record, other))
    assert found.factors == (3, 2)
    assert found.records[0].dt == found.records[1].dt == pytest.approx(0.1)
    assert found.records[0].u.tolist() == [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 0.0]
    assert found.records[0].y.tolist() == pytest.approx([5.0, 6.0, 7.0, 8.0, 6.0, 4.0, 2.0])
    data = found.prepared(0)
    assert data.measured().tolist() == [5.0, 8.0, 2.0, 1.0, 2.0, 3.0]
    assert found.prepared(1).measured().tolist() == [8.0, 2.0, 2.0, 3.0]


@pytest.mark.parametrize("times", [(1e-3, 1.7e-2), (1e-3, 1e-3 * np.pi), (3e-3, 1.4e-3, 1.1e-3)])
def test_times_that_nothing_divides_are_refused(times: tuple[float, ...]) -> None:
    records = [Record(fine(1).u, fine(1).y, dt) for dt in times]
    with pytest.raises(InputError, match="none divides all of these with less than 17 samples"):
        identified(records)
