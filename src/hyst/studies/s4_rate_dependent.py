"""S4: Al Janaideh and Krejčí, the inverse of the rate-dependent Prandtl-Ishlinskii model.

The paper calls its inverse exact. It is, where both models see the same thresholds over time. As a
feedforward it takes the rate of the reference, the actuator that of its own drive; what is left
then is computed here for the paper's example (sec. III-F) and its actuator (sec. IV-C), beside
what other inversions leave.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import Compensation, invert_trajectory
from hyst.models import GivenThresholds, RateDependentPrandtlIshlinskii
from hyst.report.rate_dependent_figures import draw_error_over_frequency, draw_tracking
from hyst.report.table import Table

Array = NDArray[np.float64]
TITLE = "Al Janaideh and Krejčí: inverse rate-dependent Prandtl-Ishlinskii model"

DT = 1e-4
EXAMPLE = RateDependentPrandtlIshlinskii(
    p=[0.3667, 0.2690, 0.1973, 0.1447], r=[3.0, 6.0, 9.0, 12.0], beta=28 / 40000, dt=DT, p0=0.5
)
ACTUATOR = RateDependentPrandtlIshlinskii(
    p=[0.2906, 0.0461, 0.1512], r=[9.715, 19.43, 29.145], beta=8.572e-4, dt=DT, p0=0.7124
)

METHODS = ("rate-independent", "explicit", "sample-exact", "preview", "trajectory")
FREQUENCIES = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 60.0, 100.0, 200.0)
SHOWN = (10.0, 60.0)
DRIVEN = 100.0
PERIODS = 3
MOST_SAMPLES_A_PERIOD = 1000


def example_reference(f: float, dt: float) -> Array:
    """Give the reference of sec. III-F over whole periods.

    Parameters
    ----------
    f
        Fundamental frequency, Hz.
    dt
        Sample time, seconds.

    Returns
    -------
    numpy.ndarray
    """
    t = np.arange(round(PERIODS / f / dt)) * dt
    return np.asarray(22.0 * np.sin(2.0 * np.pi * f * t) + 25.0 * np.sin(6.0 * np.pi * f * t))


def actuator_reference(f: float, dt: float) -> Array:
    """Give a harmonic reference of amplitude 40, as sec. IV drives the actuator.

    Parameters
    ----------
    f
        Frequency, Hz.
    dt
        Sample time, seconds.

    Returns
    -------
    numpy.ndarray
    """
    t = np.arange(round(PERIODS / f / dt)) * dt
    return np.asarray(40.0 * np.sin(2.0 * np.pi * f * t))


@dataclass(frozen=True, eq=False)
class Case:
    """One reference and the commands of all methods, judged on the middle period.

    Parameters
    ----------
    name
        ``example`` or ``actuator``.
    f
        Frequency, Hz.
    model
        With the sample time of this case.
    y_ref
        The reference.
    found
        By method.
    """

    name: str
    f: float
    model: RateDependentPrandtlIshlinskii
    y_ref: Array
    found: dict[str, Compensation]

    @property
    def middle(self) -> slice:
        """The middle period."""
        third = self.y_ref.size // PERIODS
        return slice(third, 2 * third)

    def error(self, method: str) -> Array:
        """Give the consistent error of a method over the middle period.

        Parameters
        ----------
        method
            One of those solved for.

        Returns
        -------
        numpy.ndarray
        """
        return self.found[method].predicted_error[self.middle]

    def largest(self, method: str) -> float:
        """Give the largest absolute error over the middle period.

        Parameters
        ----------
        method
            One of those solved for.

        Returns
        -------
        float
        """
        return float(np.abs(self.error(method)).max())

    def uncompensated(self) -> float:
        """Give the largest error if the reference itself is the drive."""
        return float(np.abs((self.model(self.y_ref) - self.y_ref)[self.middle]).max())


def solve(name: str, f: float, methods: tuple[str, ...] = METHODS) -> Case:
    """Invert one reference by all methods.

    Parameters
    ----------
    name
        ``example`` or ``actuator``.
    f
        Frequency, Hz.
    methods
        Which ones.

    Returns
    -------
    Case
    """
    # The paper samples at 10 kHz; a slow period would have a hundred thousand samples.
    dt = max(DT, 1.0 / (f * MOST_SAMPLES_A_PERIOD))
    original, reference = {
        "example": (EXAMPLE, example_reference),
        "actuator": (ACTUATOR, actuator_reference),
    }[name]
    model = RateDependentPrandtlIshlinskii(original.p, original.r, original.beta, dt, original.p0)
    y_ref = reference(f, dt)
    return Case(name, f, model, y_ref, {each: _invert(model, y_ref, each) for each in methods})


def _invert(model: RateDependentPrandtlIshlinskii, y_ref: Array, method: str) -> Compensation:
    if method == "rate-independent":
        u = model.at_rest().inverse()(y_ref)
        return Compensation(u, y_ref, model(u), method, 0)
    return invert_trajectory(model, y_ref, method, allow_unconverged=True)


@functools.cache
def _cases() -> dict[str, dict[float, Case]]:
    """All cases of the study, by model and frequency."""
    return {
        name: {f: solve(name, f) for f in sorted({*FREQUENCIES, *SHOWN})}
        for name in ("example", "actuator")
    }


def _shown() -> tuple[Case, ...]:
    example = _cases()["example"]
    return (*(example[f] for f in SHOWN), _cases()["actuator"][DRIVEN])


def tables() -> tuple[Table, ...]:
    """Compute the paper's numbers, and what its inverse leaves beside what others leave.

    Returns
    -------
    tuple of Table
    """
    return (
        inverse_constants(),
        round_trip(),
        *(methods_table(case) for case in _shown()),
        *(frequency_table(list(group.values())) for group in _cases().values()),
        claims_table(_cases()["actuator"]),
        conclusions(*_shown()[:2]),
    )


def figures() -> dict[str, bytes]:
    """Draw loops, errors over time, and error over frequency.

    Returns
    -------
    dict
        PNG by file name.
    """
    over_frequency = {
        name: {m: [case.largest(m) for case in group.values()] for m in METHODS}
        for name, group in _cases().items()
    }
    frequencies = list(_cases()["example"])
    return {
        **{f"s4-{case.name}-{case.f:g}-hz.png": _tracking_figure(case) for case in _shown()},
        "s4-error-over-frequency.png": draw_error_over_frequency(frequencies, over_frequency),
    }


def _tracking_figure(case: Case) -> bytes:
    third = case.middle
    t = np.arange(third.stop - third.start) * case.model.dt
    outputs = {m: case.found[m].y_predicted[third] for m in METHODS if m != "sample-exact"}
    return draw_tracking(t, case.y_ref[third], outputs, f"{case.name}, {case.f:g} Hz")


def inverse_constants() -> Table:
    """Compare the printed constants of the actuator's inverse with eqs. 14-15."""
    inverse = ACTUATOR.explicit_inverse()
    printed = {
        "b0": (1.3892, inverse.p0),
        "b1": (-0.3961, inverse.p[0]),
        "b2": (-0.038, inverse.p[1]),
        "b3": (-0.1187, inverse.p[2]),
        "s1": (7.0293, inverse.r[0]),
        "s2": (16.8823, inverse.r[1]),
        "s3": (27.1395, inverse.r[2]),
        "rate factor": (6.2024e-4, inverse.beta),
    }
    return Table(
        "Inverse of the identified actuator, sec. V: printed, and by eqs. 14-15 from the printed a",
        ("constant", "printed", "computed"),
        tuple((name, f"{a:.6g}", f"{b:.6g}") for name, (a, b) in printed.items()),
    )


def round_trip() -> Table:
    """Show in what sense the inverse is exact."""
    rows = []
    for name, model, reference in (
        ("example", EXAMPLE, example_reference),
        ("actuator", ACTUATOR, actuator_reference),
    ):
        for f in (10.0, 60.0):
            u = reference(f, DT)
            same = GivenThresholds(model.p, model.thresholds(u), model.p0)
            error = float(np.abs(same.inverse()(same(u)) - u).max() / np.ptp(u))
            rows.append((name, f"{f:g}", "0 (exact)", f"{error:.1e}"))
    return Table(
        "Round trip with the same thresholds over time: largest error over the range",
        ("model", "Hz", "paper", "computed"),
        tuple(rows),
    )


def methods_table(case: Case) -> Table:
    """List what every method leaves of one reference.

    Parameters
    ----------
    case
        Solved by all methods.

    Returns
    -------
    Table
    """
    amplitude = float(np.abs(case.y_ref).max())
    rows = []
    for method in METHODS:
        done, error = case.found[method], case.error(method)
        rows.append(
            (
                method,
                f"{case.largest(method):.4g}",
                f"{np.sqrt(np.mean(error**2)):.4g}",
                f"{100.0 * case.largest(method) / amplitude:.2g}",
                f"{done.total_variation:.3f}",
                f"{done.peak_rate:.2f}",
                f"{done.reversals}",
            )
        )
    claim = "paper: no error" if case.name == "example" else "paper, measured: 1 to 2 um"
    return Table(
        f"{case.name} at {case.f:g} Hz, middle period, amplitude {amplitude:.3g} ({claim} with the "
        "explicit inverse)",
        ("method", "max", "rms", "% of amplitude", "variation", "peak rate", "turns"),
        tuple(rows),
    )


def frequency_table(cases: list[Case]) -> Table:
    """List the largest error of every method over frequency.

    Parameters
    ----------
    cases
        Of one model.

    Returns
    -------
    Table
    """
    return Table(
        f"{cases[0].name}: largest consistent error over frequency",
        ("Hz", "dt [ms]", *METHODS),
        tuple(
            (
                f"{case.f:g}",
                f"{1e3 * case.model.dt:g}",
                *(f"{case.largest(method):.3g}" for method in METHODS),
            )
            for case in cases
        ),
    )


def claims_table(cases: dict[float, Case]) -> Table:
    """Set the paper's measured errors of fig. 6 beside simulated ones of its own model.

    Parameters
    ----------
    cases
        Of the actuator, by frequency.

    Returns
    -------
    Table
    """
    slow, fast = cases[min(cases)], cases[DRIVEN]
    return Table(
        "Actuator, largest positioning error from low frequency to 100 Hz, fig. 6",
        ("drive", "measured by the paper [um]", "simulated with its model"),
        (
            (
                "the reference itself",
                "5.9 to 10.6",
                f"{slow.uncompensated():.3g} to {fast.uncompensated():.3g}",
            ),
            *(
                (
                    method,
                    "1.0 to 2.0" if method == "explicit" else "-",
                    f"{slow.largest(method):.2g} to {fast.largest(method):.2g}",
                )
                for method in ("explicit", "preview", "trajectory")
            ),
        ),
    )


def conclusions(slow: Case, fast: Case) -> Table:
    """Say in words what the numbers of the example show.

    Parameters
    ----------
    slow, fast
        The example at two frequencies.

    Returns
    -------
    Table
    """
    slope = fast.model.sample_equation_slope()
    sentences = (
        "The explicit inverse is exact only for thresholds that are given functions of time.",
        f"With it the example keeps {slow.largest('explicit'):.3g} at {slow.f:g} Hz and "
        f"{fast.largest('explicit'):.3g} at {fast.f:g} Hz on an amplitude of 37,",
        f"with the rate-independent inverse {slow.largest('rate-independent'):.3g} and "
        f"{fast.largest('rate-independent'):.3g},",
        f"with a preview of 20 samples {slow.largest('preview'):.2g} and "
        f"{fast.largest('preview'):.2g},",
        f"with the whole trajectory known {slow.largest('trajectory'):.2g} and "
        f"{fast.largest('trajectory'):.2g}.",
        f"Solving sample by sample is exact but turns {fast.found['sample-exact'].reversals} times "
        "where the reference turns 18 times:",
        f"at this sample time the slope of a sample's equation falls to {slope:.3g}.",
    )
    return Table("What follows", ("",), tuple((each,) for each in sentences))
