"""Speed of a fit: hyst against SciPy's least squares with a residual and Jacobian by numba.

Prints, of one run and in processor time,
- weights and radii of four and of ten plays, 10^4 samples: the peer starts once, from radii that
  are evenly spaced and weights that are equal; both times, and what each leaves (rms),
- diagnosis, choice among all families and fit of 8000 samples of several actuators, in units of
  the peer's fit of ten plays.
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, ratio, report, report_times

Array = NDArray[np.float64]

SAMPLES = 10_000
RECORD = 8_000
NOISE = 0.01
FOUR = hyst.PrandtlIshlinskii([0.5, 0.4, 0.3, 0.2], [0.08, 0.22, 0.43, 0.71], 1.0)
TEN = hyst.PrandtlIshlinskii(np.linspace(0.5, 0.1, 10), np.linspace(0.06, 0.8, 10), 1.0)
MAPPED = hyst.ModifiedPrandtlIshlinskii(FOUR, hyst.DeadZone([1.0, 0.1, -0.1], [0.0, 0.7, -0.7]))
SOFTENING = hyst.PrandtlIshlinskii([-0.2, -0.1, -0.15], [0.1, 0.3, 0.6], 1.0)


def main() -> None:
    """Print both tables."""
    if importlib.util.find_spec("numba") is None:
        print("numba is not installed; nothing to compare with")
        return
    print_fits()
    print_choices(unit_seconds())


def unit_seconds() -> float:
    """Time the peer's fit of ten plays to 10^4 samples, s of processor time.

    Seconds of fits say little of another machine, or of one that is busy: benchmarks of fits tell
    them in this unit too, measured in the same run.
    """
    record = measured(TEN, multisine(SAMPLES))
    return float(np.median(interleaved({"peer": lambda: peer(record, 10)}, seconds=2.0)["peer"]))


def unit_told() -> str:
    """Say how long a unit is here and now; nothing where numba is not installed."""
    if importlib.util.find_spec("numba") is None:
        return ""
    return f"a unit is {unit_seconds():.3f} s of processor time: the peer's fit of ten plays"


def print_fits() -> None:
    """Print times and residuals of fits of a given size."""
    print(f"weights and radii, {SAMPLES} samples, noise {NOISE}: hyst / numba + scipy")
    for plays, truth in ((4, FOUR), (10, TEN)):
        for name, drive in DRIVES.items():
            record = measured(truth, drive(SAMPLES))
            for told in ("0", "auto"):
                delay = 0 if told == "0" else told
                works = {
                    "hyst": lambda r=record, n=plays, d=delay: ours(r, n, d),
                    "peer": lambda r=record, n=plays: peer(r, n),
                }
                times = interleaved(works, seconds=4.0, rounds=7)
                told_as = f"hyst over peer, {plays} plays, {name}, delay {told}"
                report_times(told_as, times, "hyst", "peer", better="smaller")
                left = {each: work() for each, work in works.items()}
                least = {each: float(np.median(times[each])) for each in times}
                print(
                    f"  {plays:2d} plays, {name:16s} delay {told:4s}  hyst {least['hyst']:.3f} s, "
                    f"peer {least['peer']:.3f} s, ratio {ratio(times, 'hyst', 'peer'):5.2f};  rms "
                    f"{left['hyst']:.5f} / {left['peer']:.5f}"
                )


def print_choices(unit: float) -> None:
    """Print the time of diagnosis, fit and choice among all families."""
    print(f"all families, {RECORD} samples; a unit is {unit:.3f} s: the peer's fit of ten plays")
    for name, truth in ACTUATORS.items():
        for driven, drive in DRIVES.items():
            record = measured(truth, drive(RECORD))
            before = time.process_time()
            found = hyst.identify(record)
            spent = time.process_time() - before
            report(f"units of a choice, {name}, {driven}", spent / unit, better="smaller")
            print(
                f"  {name:10s} {driven:16s} {spent:6.2f} s  {spent / unit:6.1f} units  "
                f"{found.family}, {found.parameter_values.size} numbers"
            )


def ours(record: hyst.Record, plays: int, delay: float | str) -> float:
    """Identify weights and radii; give what is left over the samples the peer takes, rms."""
    found = hyst.identify(record, family="pi", plays=plays, delay=delay)
    return rms((found.model(record.u) - record.y)[first_used(record.u) :])


def peer(record: hyst.Record, plays: int) -> float:
    """Fit weights and radii from one start; give what is left, rms."""
    u, y = record.u, record.y
    start = first_used(u)
    bank = compiled()
    half = float(np.ptp(u)) / 2.0
    radii = half * np.arange(1, plays + 1) / (plays + 1)
    slope = float(np.ptp(y) / np.ptp(u))
    theta = np.concatenate([np.full(plays + 1, slope / (plays + 1)), radii, [y.mean()]])
    lower = np.concatenate([np.zeros(plays + 1), np.full(plays, 1e-6), [-np.inf]])
    upper = np.concatenate([np.full(plays + 1, np.inf), np.full(plays, 0.95 * half), [np.inf]])

    def residual(theta: Array) -> Array:
        out, _ = bank(u, theta, plays, False)
        return (out - y)[start:]

    def jacobian(theta: Array) -> Array:
        return bank(u, theta, plays, True)[1][start:]

    found = scipy.optimize.least_squares(
        residual, theta, jacobian, bounds=(lower, upper), x_scale="jac"
    )
    return rms(found.fun)


def rms(values: Array) -> float:
    """Give the root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def first_used(u: Array) -> int:
    """Give a sample from which on the memory is known: the input has passed its range."""
    return int(max(np.argmax(u >= 0.95 * u.max()), np.argmax(u <= 0.95 * u.min())))


def compiled() -> Callable[..., tuple[Array, Array]]:
    """Give the play bank with its derivatives by weights, radii and offset, by numba."""
    if not _COMPILED:
        import numba

        _COMPILED.append(numba.njit(plays_and_derivatives, fastmath=True))
    return _COMPILED[0]


_COMPILED: list[Callable[..., tuple[Array, Array]]] = []


def plays_and_derivatives(
    u: Array, theta: Array, n: int, with_jacobian: bool
) -> tuple[Array, Array]:
    """Give output and, where asked for, derivatives, sample by sample."""
    z, by_r = np.zeros(n), np.zeros(n)
    y = np.empty(u.size)
    jacobian = np.empty((u.size if with_jacobian else 0, 2 * n + 2))
    for k in range(u.size):
        total = theta[0] * u[k] + theta[2 * n + 1]
        for i in range(n):
            r = theta[n + 1 + i]
            if u[k] - r > z[i]:
                z[i] = u[k] - r
                by_r[i] = -1.0
            elif u[k] + r < z[i]:
                z[i] = u[k] + r
                by_r[i] = 1.0
            total += theta[1 + i] * z[i]
            if with_jacobian:
                jacobian[k, 1 + i] = z[i]
                jacobian[k, n + 1 + i] = theta[1 + i] * by_r[i]
        y[k] = total
        if with_jacobian:
            jacobian[k, 0] = u[k]
            jacobian[k, 2 * n + 1] = 1.0
    return y, jacobian


def measured(truth: Callable[[Array], Array], u: Array) -> hyst.Record:
    """Give a record of a plant with an offset and white noise."""
    noise = NOISE * np.random.default_rng(1).standard_normal(u.size)
    return hyst.Record(u, truth(u) + 0.3 + noise, dt=1e-3)


def decaying(samples: int) -> Array:
    """Give a sine whose amplitude shrinks and grows again."""
    t = np.arange(samples) * 1e-3
    return (1.0 - 0.6 * np.sin(np.pi * t / t[-1])) * np.sin(2.0 * np.pi * 5.0 * t + 0.3)


def multisine(samples: int) -> Array:
    """Give a random-phase multisine with peak 1."""
    phases = np.random.default_rng(7).uniform(0.0, 2.0 * np.pi, 20)
    angles = 2.0 * np.pi * np.outer(np.arange(samples), np.arange(1, 21)) * 2.0 / samples
    waves = np.sin(angles + phases).sum(axis=1)
    return np.asarray(waves / np.abs(waves).max())


DRIVES: dict[str, Callable[[int], Array]] = {"decaying sine": decaying, "multisine": multisine}


def bouc_wen(u: Array) -> Array:
    """Give a Bouc-Wen element beside a spring, in small steps."""
    z, out = 0.0, np.zeros(u.size)
    for k, change in enumerate(np.diff(u), 1):
        for _ in range(20):
            z += (1.0 - abs(z) ** 1.5 * (2.0 * np.sign(z * change) + 1.0)) * change / 20.0
        out[k] = 0.5 * u[k] + 0.3 * z
    return out


def drifting(u: Array) -> Array:
    """Give four plays whose output drifts."""
    return FOUR(u) + 0.3 * np.linspace(0.0, 1.0, u.size) ** 2


def duhem(u: Array) -> Array:
    """Give a Duhem model that relaxes to a saturating curve, in small steps."""
    out = np.zeros(u.size)
    for k, change in enumerate(np.diff(u), 1):
        out[k] = out[k - 1]
        for _ in range(10):
            towards = 2.0 * (np.tanh(1.5 * u[k - 1]) - out[k]) * abs(change)
            out[k] += (towards + 0.4 * change) / 10.0
    return out


def relays(u: Array) -> Array:
    """Give 400 relays beside a spring."""
    ends = np.sort(np.random.default_rng(3).uniform(-1.0, 1.0, (400, 2)), axis=1)
    state, out = -np.ones(400), np.empty(u.size)
    for k, x in enumerate(u):
        state[x >= ends[:, 1]] = 1.0
        state[x <= ends[:, 0]] = -1.0
        out[k] = state.mean() + 0.2 * x
    return out


def rated(u: Array) -> Array:
    """Give three plays that widen with the rate."""
    rates, z, out = np.abs(np.gradient(u, 1e-3)), np.zeros(3), np.empty(u.size)
    for k, x in enumerate(u):
        r = np.array([0.1, 0.3, 0.5]) * (1.0 + 0.02 * rates[k])
        z = np.maximum(x - r, np.minimum(x + r, z))
        out[k] = x + 0.4 * z.sum()
    return out


ACTUATORS: dict[str, Callable[[Array], Array]] = {
    "plays": FOUR,
    "mapped": MAPPED,
    "softening": SOFTENING,
    "bouc-wen": bouc_wen,
    "drifting": drifting,
    "duhem": duhem,
    "relays": relays,
    "rates": rated,
}


if __name__ == "__main__":
    main()
