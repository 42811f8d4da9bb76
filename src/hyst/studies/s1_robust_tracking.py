"""S1: El-Shaer, Al Janaideh, Krejčí and Tomizuka, disturbance observers for inexact inverses.

The constants of the inverse follow from the printed model. The printed observer does not do what
is claimed: with the printed controller ``8 + 4/s`` the loop around the two-mode plant is unstable,
and no gain brings the norm of eq. 36 below 2.126. With ``4 + 8/s`` the example works, and the
claim of sec. 5 holds: the observer brings an inverse of 70 % back to the error of the exact one.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import error_bound, reduce_inverse, slope_range
from hyst.control import (
    DisturbanceObserver,
    InverseComparison,
    closed_loop_poles,
    compare_inverses,
    design_disturbance_observer,
    evaluate_gain,
    slope_margin,
)
from hyst.control.disturbance_observer import observer_problem
from hyst.control.linear_system import as_linear_system
from hyst.models import GeneralizedPrandtlIshlinskii, PrandtlIshlinskii
from hyst.operators import Affine, DeadZone, Operator
from hyst.report.robust_tracking_figures import draw_all
from hyst.report.table import Table
from hyst.studies.what_runs_of_s1 import beyond_the_paper

Array = NDArray[np.float64]
TITLE = "El-Shaer, Al Janaideh, Krejčí and Tomizuka: disturbance observers for inexact inverses"

# Sec. 5.1.
W1, Z1, W2, Z2 = 2.0 * np.pi * 90.0, 0.8, 2400.0, 0.2
_FIRST, _SECOND = [1.0, 2.0 * Z1 * W1, W1**2], [1.0, 2.0 * Z2 * W2, W2**2]
PLANT = as_linear_system(([W1**2], _FIRST))
TRUE_PLANT = as_linear_system(([W1**2 * W2**2], np.polymul(_FIRST, _SECOND)))
WU = as_linear_system(([-1.0, -2.0 * Z2 * W2, 0.0], _SECOND))
WP = as_linear_system(([0.5, 64.0 * np.pi], [1.0, 0.2]))
PRINTED_CONTROLLER = as_linear_system(([8.0, 4.0], [1.0, 0.0]))
CONTROLLER = as_linear_system(([4.0, 8.0], [1.0, 0.0]))
PRINTED_GAIN = (-117.381, 0.197, 17113.1)
PRINTED_GAMMA = 0.774
PRINTED_Q = (1.0, 6.393e4, 1.981e7, 5.472e9)

# Sec. 5.2.
PLAYS = PrandtlIshlinskii(
    [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7],
    np.arange(4.0, 41.0, 4.0),
    0.1,
)
PRINTED_S = (0.4, 0.985, 1.8459, 3.1186, 5.00, 7.8085, 11.9784, 18.1875, 27.4386, 41.2279)
PRINTED_G = (
    *(10.0, -3.16, -2.1918, -1.5030, -1.0231, -0.6930),
    *(-0.4678, -0.315, -0.2118, -0.1423, -0.0955),
)

# Sec. 5.3; the envelope must be odd (sec. 2.1), which eqs. 49-50 alone do not make it.
XI, RHO = (0.65, 0.2, 0.3, 0.4), (0.0, 7.56, 12.0, 17.69)
PRINTED_PSI, PRINTED_EPSILON = (4.94, 8.688, 15.2315), (1.5385, -0.361, -0.3069, -0.2244)
GENERALIZED = GeneralizedPrandtlIshlinskii(DeadZone.odd(XI, RHO), PLAYS)

FACTORS = (0.95, 0.9, 0.7, 0.5)
FIG_12 = (0.9, 0.8, 0.7, 0.4, 0.1)
DT, DURATION, SETTLE = 2e-5, 3.0, 1.0


def reference(dt: float = DT, duration: float = DURATION) -> Array:
    """Give ``18 sin(2 pi t) + 28 sin(6 pi t)``.

    Parameters
    ----------
    dt, duration
        Seconds.

    Returns
    -------
    numpy.ndarray
    """
    t = np.arange(round(duration / dt)) * dt
    return np.asarray(18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t))


@dataclass(frozen=True, eq=False)
class Designs:
    """The printed gain and the best one, in one loop.

    Parameters
    ----------
    printed
        The printed gain, certified.
    best
        The best gain found.
    """

    printed: DisturbanceObserver
    best: DisturbanceObserver


@functools.cache
def designs(repaired: bool) -> Designs:
    """Certify the printed gain and find the best one, with one of both controllers.

    Parameters
    ----------
    repaired
        Whether C is ``4 + 8/s`` instead of the printed ``8 + 4/s``.

    Returns
    -------
    Designs
    """
    controller = CONTROLLER if repaired else PRINTED_CONTROLLER
    problem = observer_problem(PLANT, controller, WU, WP)
    best = design_disturbance_observer(PLANT, controller, WU, WP, perturbed_plant=TRUE_PLANT)
    return Designs(evaluate_gain(problem, PRINTED_GAIN, TRUE_PLANT), best)


def inverses(model: Operator, factors: tuple[float, ...] = FACTORS) -> dict[str, Operator | None]:
    """Give the inverses of the paper: exact, scaled, none, and one of four plays.

    Parameters
    ----------
    model
        Hysteresis.
    factors
        Of the scaled ones.

    Returns
    -------
    dict
        By name.
    """
    exact = model.inverse()
    scaled = {f"{each:g}": Affine(each) @ exact for each in factors}
    four = reduce_inverse(model, 4, float(np.abs(reference()).max()))
    return {"exact": exact, **scaled, "4 plays": four, "none": None}


@functools.cache
def tracked(generalized: bool, printed: bool = False) -> InverseComparison:
    """Simulate the repaired loop with all inverses, with and without an observer.

    Parameters
    ----------
    generalized
        Whether the hysteresis has the envelope of sec. 5.3.
    printed
        Whether the observer is the printed one instead of the best.

    Returns
    -------
    InverseComparison
    """
    model: Operator = GENERALIZED if generalized else PLAYS
    both = designs(repaired=True)
    factors = FACTORS if printed else tuple(sorted({*FACTORS, *FIG_12}, reverse=True))
    return compare_inverses(
        reference(),
        DT,
        inverses(model, factors),
        observer=both.printed if printed else both.best,
        plant=TRUE_PLANT,
        controller=CONTROLLER,
        hysteresis=model,
        settle=SETTLE,
    )


def tables() -> tuple[Table, ...]:
    """Compute the paper's numbers, its design as it is, and the repaired example.

    Returns
    -------
    tuple of Table
    """
    return (
        inverse_constants(),
        envelope_constants(),
        filter_table(),
        designs_table(),
        tracking_table(generalized=False),
        tracking_table(generalized=True),
        bound_table(),
        circle_table(),
        *beyond_the_paper(designs(repaired=True).best),
        conclusions(),
    )


def figures() -> dict[str, bytes]:
    """Draw Figs. 5 and 7 to 12 with the repaired example.

    Returns
    -------
    dict
        PNG by file name.
    """
    loops = tracked(generalized=False), tracked(generalized=True)
    best, r = designs(repaired=True).best, reference(2e-4, 2.0)
    return draw_all(best, TRUE_PLANT, r, (PLAYS, GENERALIZED), loops)


def inverse_constants() -> Table:
    """Compare the printed constants of the inverse plays with eqs. 7-8."""
    exact = PLAYS.exact_inverse()
    rows = [("g0", f"{PRINTED_G[0]:g}", f"{exact.p0:.4f}", "0.0")]
    for name, printed, computed in (("s", PRINTED_S, exact.r), ("g", PRINTED_G[1:], exact.p)):
        rows += [
            (f"{name}{k + 1}", f"{a:g}", f"{b:.4f}", f"{100.0 * (b - a) / a:+.1f}")
            for k, (a, b) in enumerate(zip(printed, computed, strict=True))
        ]
    return Table(
        "Inverse of the plays of sec. 5.2: printed, and by eqs. 7-8 from the printed weights",
        ("constant", "printed", "computed", "% off"),
        tuple(rows),
    )


def envelope_constants() -> Table:
    """Compare the printed constants of the inverse envelope with eqs. 52-55."""
    inverse = DeadZone.odd(XI, RHO).exact_inverse()
    right = inverse.thresholds > 0.0
    psi, epsilon = inverse.thresholds[right], inverse.weights[right]
    linear = float(inverse.weights[inverse.thresholds == 0.0][0])
    rows = [("epsilon0", f"{PRINTED_EPSILON[0]:g}", f"{linear:.4f}")]
    rows += [
        (f"psi{k + 1}", f"{a:g}", f"{b:.4f}")
        for k, (a, b) in enumerate(zip(PRINTED_PSI, psi, strict=True))
    ]
    rows += [
        (f"epsilon{k + 1}", f"{a:g}", f"{b:.4f}")
        for k, (a, b) in enumerate(zip(PRINTED_EPSILON[1:], epsilon, strict=True))
    ]
    return Table(
        "Inverse envelope of sec. 5.3: printed, and by eqs. 52-55",
        ("constant", "printed", "computed"),
        tuple(rows),
    )


def filter_table() -> Table:
    """Compare the printed Q(s), eq. 47, with the one that follows from the printed gain."""
    found = designs(repaired=True).printed.certificate.Q_denominator
    return Table(
        "Denominator of Q(s) from the printed gain, eq. 47",
        ("coefficient of", "printed", "computed"),
        tuple(
            (f"s^{3 - k}", f"{a:.4g}", f"{b:.4g}")
            for k, (a, b) in enumerate(zip(PRINTED_Q, found, strict=True))
        ),
    )


def designs_table() -> Table:
    """List what each gain really achieves, with the printed and the repaired controller."""
    rows = []
    for repaired in (False, True):
        name = "4 + 8/s" if repaired else "8 + 4/s"
        both = designs(repaired)
        for gain, each in (("printed", both.printed), ("best found", both.best)):
            c = each.certificate
            claimed = f"{PRINTED_GAMMA}" if gain == "printed" and not repaired else "-"
            poles = c.perturbed_poles
            worst = complex(poles[int(np.argmax(poles.real))]) if poles is not None else 0.0
            rows.append(
                (
                    f"C = {name}, {gain} L",
                    claimed,
                    f"{c.stacked_norm:.4f}",
                    f"{c.uncertainty_norm:.4f}",
                    f"{c.performance_norm:.4f}",
                    f"{worst.real:+.4g}",
                    "stable" if c.perturbed_stable else "UNSTABLE",
                )
            )
    return Table(
        "Norm of eq. 36 and the loop around the two-mode plant",
        ("design", "claimed", "norm", "Wu T", "Wp (1 - Q)", "pole [1/s]", "loop"),
        tuple(rows),
    )


def tracking_table(generalized: bool) -> Table:
    """List tracking errors of the repaired example by inverse.

    Parameters
    ----------
    generalized
        Whether the hysteresis has the envelope of sec. 5.3.

    Returns
    -------
    Table
    """
    best, printed = tracked(generalized), tracked(generalized, printed=True)
    model: Operator = GENERALIZED if generalized else PLAYS
    approximations = inverses(model)
    rows = []
    for name in ("exact", *(f"{each:g}" for each in FACTORS), "4 plays", "none"):
        loops = best.without[name], best.observed[name], printed.observed[name]
        recovered = best.recovered(name)
        reach = float(np.abs(loops[1].v).max())
        slopes = slope_range(model, approximations[name] or Affine(1.0), reach)
        margin = slope_margin(TRUE_PLANT, CONTROLLER, designs(repaired=True).best, slopes)
        rows.append(
            (
                name,
                *(f"{value:.3f}" for each in loops for value in (each.rms_error, each.max_error)),
                "-" if np.isnan(recovered) else f"{100.0 * recovered:.1f}",
                "proven stable" if margin > 1.0 else "NOT proven safe",
            )
        )
    what = "GPI model, sec. 5.3" if generalized else "PI model, sec. 5.2"
    return Table(
        f"Tracking error with C = 4 + 8/s, {what}, after {SETTLE:g} s; share of the rms error "
        "added by the inverse that the observer takes off",
        (
            "inverse",
            *("rms without", "max", "rms with best L", "max", "rms with printed L", "max"),
            "recovered [%]",
            "loop with best L",
        ),
        tuple(rows),
    )


def bound_table() -> Table:
    """List the bound of eq. 16 for the inverses of the paper, over the reference's range."""
    y_max = float(np.abs(reference()).max())
    rows = []
    for kind, model in (("PI", PLAYS), ("GPI", GENERALIZED)):
        approximations = inverses(model)
        for name in (*(f"{each:g}" for each in FACTORS), "4 plays", "none"):
            limit = error_bound(model, approximations[name] or Affine(1.0), y_max)
            rows.append(
                (
                    f"{kind}, {name}",
                    f"{limit.envelope_error:.3f}",
                    f"{limit.lipschitz:.3f}",
                    f"{limit.plays_error:.3f}",
                    f"{limit.bound:.3f}",
                    f"{limit.reached:.3f}",
                    f"{limit.output_bound:.3f}",
                )
            )
    return Table(
        f"Eq. 16 over |w| <= {y_max:.2f}: envelope + L x integral, what an example reaches, and "
        "the bound of the output, which eq. 17 needs",
        ("inverse", "envelope", "L", "integral", "bound", "reached", "of output"),
        tuple(rows),
    )


def circle_table() -> Table:
    """List between which slopes hysteresis and inverse act, and whether that is proven stable."""
    best = designs(repaired=True).best
    rows = []
    for name, inverse in inverses(PLAYS).items():
        loop = tracked(generalized=False).observed[name]
        reach = float(np.abs(loop.v).max())
        slopes = slope_range(PLAYS, inverse or Affine(1.0), reach)
        margins = [slope_margin(TRUE_PLANT, CONTROLLER, o, slopes) for o in (None, best)]
        told = ["exact" if m > 1e6 else f"{m:.2f}" for m in margins]
        rows.append((name, f"{reach:.1f}", f"{slopes[0]:.3f}", f"{slopes[1]:.3f}", *told))
    return Table(
        "Slopes of plays after inverse within the range used, PI model, C = 4 + 8/s; the circle "
        "criterion proves stability above 1",
        ("inverse", "largest |v|", "least", "largest", "without observer", "with it"),
        tuple(rows),
    )


def conclusions() -> Table:
    """Say in words what the numbers show."""
    printed, repaired = designs(repaired=False), designs(repaired=True)
    found = tracked(generalized=False)
    unstable = closed_loop_poles(TRUE_PLANT, PRINTED_CONTROLLER)[0]
    sentences = (
        f"The printed gamma of {PRINTED_GAMMA} is not reached: the printed gain has "
        f"{printed.printed.gamma:.3f}, the best found {printed.best.gamma:.3f} "
        f"({'; '.join(' '.join(each.split()) for each in printed.best.steps)}).",
        "With the printed controller the loop around the two-mode plant is unstable, also without "
        f"observer: pole at {unstable.real:+.0f} 1/s.",
        f"With C = 4 + 8/s the printed gain has {repaired.printed.gamma:.3f}, the best "
        f"{repaired.best.gamma:.4f}.",
        f"There the rms error is {found.without['exact'].rms_error:.2f} with the exact inverse, "
        f"{found.without['0.7'].rms_error:.2f} with 0.7 of it and "
        f"{found.observed['0.7'].rms_error:.2f} with the observer:",
        f"{100.0 * found.recovered('0.7'):.1f} % of what the inexact inverse adds is recovered.",
        f"Without any inverse it is {found.without['none'].rms_error:.2f}. The loop is unstable "
        "for slopes above 1.4, the plays have up to 3.4:",
        "the drive breaks into bursts as long as they are that steep; the loop stays bounded.",
    )
    return Table("What follows", ("",), tuple((each,) for each in sentences))
