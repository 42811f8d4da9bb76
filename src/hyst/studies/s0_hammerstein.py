"""S0: Aljanaideh, Al Janaideh, Rakotondrabe and Kundur, Hammerstein systems with a GPI hysteresis.

The printed sample time of 1e-5 s cannot be meant: G(z) of eq. 49 is G(s) of eq. 48 at 0.01 s, and
at 1e-5 s the printed input excites 6 of 31 directions. With 0.01 s the printed input, a sum of
sines in phase, is a train of peaks, which disturbs the Markov parameters far more than a designed
input does: what the hysteresis adds is correlated with past inputs and does not average out. With a
Gaussian input it is correlated, too, for plays remember (Bussgang's theorem is for maps without
memory), but little here: the radii are small beside the amplitude. The dead zone as printed jumps
to 0 whenever the input turns, which is another nonlinearity. Zeros of G have the modulus 0.726 and
its relative degree is 1, so its inverse looks one sample ahead.
"""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from hyst.identification import identify
from hyst.identification.families.hammerstein import IdentifiedHammerstein, fit_markov
from hyst.models import (
    GeneralizedPrandtlIshlinskii,
    LinearDynamics,
    PrandtlIshlinskii,
    StableInverse,
)
from hyst.operators import DeadZone, Operator
from hyst.report.hammerstein_study_figures import (
    draw_bode,
    draw_intermediate,
    draw_loops,
    draw_markov,
)
from hyst.report.table import Table
from hyst.signals import Record, multisine, persistence

Array = NDArray[np.float64]

DT = 0.01
SAMPLES = 100_000
FIR_ORDER = 30
G = LinearDynamics.from_continuous([3.391e10], [1.0, 3759.0, 2.063e7, 7.514e10], DT)
PLAYS = PrandtlIshlinskii(
    p=[3.6590, 2.8098, 2.1577, 1.6569, 1.2724, 0.9771, 0.7503, 0.5762],
    r=[0.0769, 0.1538, 0.2307, 0.3076, 0.3845, 0.4614, 0.5383, 0.6152],
)
KNOTS = np.round(0.8 * np.arange(-8, 9), 1)
WEIGHTS = np.array(
    [
        *(-0.198, -0.057, -0.1669, -0.13, -0.15, -0.037, 0.02, 0.23, 0.0, -0.249, -0.004),
        *(-0.2176, -0.0734, 0.0568, -0.058, -0.13, -2.479),
    ]
)
"""g_1 .. g_17; g_12 is printed with a dot and a minus too many."""

TWO_SIDED = GeneralizedPrandtlIshlinskii(DeadZone(WEIGHTS, KNOTS), PLAYS)
BY_DIRECTION = PLAYS @ DeadZone(WEIGHTS, KNOTS, "by-direction")
READINGS = {"two-sided": TWO_SIDED, "as printed": BY_DIRECTION}


def printed_input(dt: float, samples: int = SAMPLES) -> Array:
    """Give ``sum_{i=1}^{1000} 5 sin(i k dt)``, in closed form.

    Parameters
    ----------
    dt
        Sample time, s.
    samples
        How many.

    Returns
    -------
    numpy.ndarray
    """
    half = 0.5 * dt * np.arange(1, samples)
    return np.append(0.0, 5.0 * np.sin(1000.0 * half) * np.sin(1001.0 * half) / np.sin(half))


def designed_input(samples: int = SAMPLES) -> Array:
    """Give a multisine of random phases and rms 30, all lines up to half the sample rate."""
    return multisine(DT, samples, rms=30.0).u


def markov_error(estimate: Array) -> float:
    """Give the relative error after scaling, in percent."""
    true = G.impulse_response(estimate.size)
    scale = float(estimate @ true) / float(true @ true)
    return 100.0 * float(np.linalg.norm(estimate / scale - true) / np.linalg.norm(true))


def relative_rms(estimate: Array, true: Array) -> float:
    """Give the rms distance of an estimate from the true signal, percent of its range, scaled."""
    columns = np.column_stack([estimate, np.ones(estimate.size)])
    fitted = columns @ np.linalg.lstsq(columns, true, rcond=None)[0]
    return 100.0 * float(np.std(fitted - true) / np.ptp(true))


def simulate(front: Operator, u: Array, noise: float = 0.0) -> tuple[Array, Record]:
    """Give v behind a front and the record of u and y, with noise of that share of the rms of y."""
    v = front(u)
    y = G(v)
    y = y + noise * y.std() * np.random.default_rng(0).normal(size=y.size)
    return v, Record(u, y, DT)


def refined(record: Record) -> IdentifiedHammerstein:
    """Identify all five steps, the knots of the map given."""
    found = identify(
        record,
        family="hammerstein",
        hysteresis="gpi",
        plays=4,
        knots=KNOTS,
        envelope="free",
        fir_order=FIR_ORDER,
        state_order=3,
        delay=0,
        allow_unconverged=True,
    )
    assert isinstance(found, IdentifiedHammerstein)
    return found


TITLE = "hysteresis followed by linear dynamics, from input and output alone"


@functools.cache
def _designed() -> tuple[Array, Record, IdentifiedHammerstein]:
    """Give v, the record and the identification without noise."""
    v, record = simulate(TWO_SIDED, designed_input())
    return v, record, refined(record)


@functools.cache
def _noisy() -> IdentifiedHammerstein:
    return refined(simulate(TWO_SIDED, designed_input(), 0.01)[1])


def tables() -> tuple[Table, ...]:
    """Compute the tables.

    Returns
    -------
    tuple of Table
        What the printed input excites; errors of the Markov parameters; errors of v.
    """
    inputs = {"printed": printed_input(DT), "designed, rms 30": designed_input()}
    errors = {
        (reading, name): markov_error(fit_markov(simulate(front, u)[1], FIR_ORDER).values)
        for reading, front in READINGS.items()
        for name, u in inputs.items()
    }
    v, _, clean = _designed()
    return _excitation(), _markov_table(errors, clean, _noisy()), _loop_table(v, clean, _noisy())


def _excitation() -> Table:
    rows = []
    for dt in (1e-5, DT):
        found = persistence(printed_input(dt), FIR_ORDER)
        rows.append((f"{dt:g} s", f"{found.rank} of {FIR_ORDER + 1}", f"{found.condition:.3g}"))
    return Table(
        "Printed input: what its regressors determine", ("T_s", "rank", "condition"), tuple(rows)
    )


def _markov_table(
    errors: dict[tuple[str, str], float],
    clean: IdentifiedHammerstein,
    noisy: IdentifiedHammerstein,
) -> Table:
    expected = {
        ("two-sided", "printed"): "34 %",
        ("as printed", "printed"): "4 %",
        ("two-sided", "designed, rms 30"): "at most 1.5 %",
    }
    rows = [
        (reading, name, "step 1", expected.get((reading, name), "-"), f"{value:.3g} %")
        for (reading, name), value in errors.items()
    ]
    for found, name, wanted in (
        (clean, "refined", "at most 0.1 %"),
        (noisy, "refined, 40 dB", "-"),
    ):
        value = markov_error(found.dynamics.impulse_response(FIR_ORDER + 1))
        rows.append(("two-sided", "designed, rms 30", name, wanted, f"{value:.3g} %"))
    return Table(
        "Relative error of the Markov parameters after scaling",
        ("dead zone", "input", "estimate", "expected", "computed"),
        tuple(rows),
    )


def _loop_table(v: Array, clean: IdentifiedHammerstein, noisy: IdentifiedHammerstein) -> Table:
    rows = []
    for name, found in (("without noise", clean), ("40 dB", noisy)):
        valid = found.loop.valid
        estimated = relative_rms(found.loop.v[valid], v[valid])
        fitted = relative_rms(found.hysteresis(found.loop.u)[valid], v[valid])
        rows.append((name, "at most 0.5 %", f"{estimated:.3g} %", f"{fitted:.3g} %"))
    return Table(
        "v behind the hysteresis: rms error in percent of its range, after scaling",
        ("noise", "expected", "from y by the inverse", "refined hysteresis"),
        tuple(rows),
    )


def figures() -> dict[str, bytes]:
    """Draw figures 3 to 6.

    Returns
    -------
    dict of bytes
        PNG by file name.
    """
    v, record, found = _designed()
    assert found.markov is not None, "its dynamics were not given"
    printed = printed_input(DT)
    h = G.impulse_response(FIR_ORDER + 1)
    by_printed = fit_markov(simulate(TWO_SIDED, printed)[1], FIR_ORDER).values
    estimates = {
        "printed input": by_printed,
        "designed input": found.markov.values,
        "refined": found.dynamics.impulse_response(FIR_ORDER + 1),
    }
    scaled = {name: m * float(m @ h) / float(m @ m) for name, m in estimates.items()}
    gain = G.dc_gain()
    part = slice(1000, 1200)
    time = DT * np.arange(3 * 628, dtype=np.float64)
    sine = 10.0 * np.sin(time)
    v_sine, sine_record = simulate(TWO_SIDED, sine)
    v_hat = StableInverse.of(found.dynamics)(sine_record.y) / gain
    last = slice(628, time.size - 50)
    return {
        "s0-fig3.png": draw_markov(h, scaled),
        "s0-fig4.png": draw_bode(
            G, {"before refinement": _before_refinement(found), "refined": found.dynamics}
        ),
        "s0-fig5.png": draw_intermediate(
            record.time[part], v[part], found.loop.v[part] / gain, "Designed input"
        ),
        "s0-fig6-time.png": draw_intermediate(
            time[last], v_sine[last], v_hat[last], "u = 10 sin(T_s k)"
        ),
        "s0-fig6-loop.png": draw_loops(sine[last], v_sine[last], v_hat[last], "u = 10 sin(T_s k)"),
    }


def _before_refinement(found: IdentifiedHammerstein) -> LinearDynamics:
    """Give the dynamics of the paper's steps, which this drive determines."""
    assert found.first_dynamics is not None, "fir_order was given"
    return found.first_dynamics
