"""Sections of a report on dynamics identified behind a hysteresis."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.identification import Identified
from hyst.identification.families.hammerstein.impulse_response.markov import MarkovParameters
from hyst.identification.families.hammerstein.told.dynamics_words import (
    bands_told,
    continuous_of,
    polynomials_told,
)
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
)
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit
from hyst.report.frequency_response_figure import draw_dynamics
from hyst.report.identification_report import Section
from hyst.report.table import Table, number
from hyst.report.tables import dynamics_table

Array = NDArray[np.float64]

RESPONSE = "frequency_response.csv"
"""File of the frequency response, beside the report."""

_MOST_POINTS = 20_000
_BINS = 40
_LEAST_IN_BIN = 8


def dynamics_sections(found: Identified) -> tuple[Section, ...]:
    """Give the sections on linear dynamics; none for a result without them.

    Parameters
    ----------
    found
        Any result.

    Returns
    -------
    tuple of Section
    """
    if not isinstance(found, IdentifiedHammerstein):
        return ()
    has_loop = found.loop.valid.stop > found.loop.valid.start
    loop = [_loop(found)] if has_loop else []
    last = [] if found.markov is None else [_response(found, found.markov)]
    return (*loop, _dynamics(found), *last)


def _response(found: IdentifiedHammerstein, markov: MarkovParameters) -> Section:
    return Section(
        heading="For comparison: the impulse response",
        texts=(
            f"Least squares on {markov.samples} samples with {markov.order + 1} lags; condition of "
            f"the regressors {markov.condition:.3g}. Bars are two standard errors; they count the "
            "distortion by the hysteresis as noise. The fit starts from it where fir_order was "
            "given, else from plays.",
        ),
        table=Table(
            "Order",
            ("order of G", "lags", "residual rms", "after refinement"),
            (
                (
                    str(found.dynamics.order),
                    str(markov.order),
                    number(markov.residual_rms),
                    number(found.noise_rms),
                ),
            ),
        ),
        picture="impulse_response.png",
        png=draw_impulse_response(found, markov),
        caption="Markov parameters, and singular values of their Hankel matrix.",
    )


def _dynamics(found: IdentifiedHammerstein) -> Section:
    inverse = found.inverse_of_dynamics
    texts = [
        "G carries no gain of its own: its gain at rest is 1, because input and output determine "
        "only the product with the hysteresis.",
        *_how_known(found),
        f"The table of gain and phase with their bands is {RESPONSE}.",
        *_in_continuous_time(found),
    ]
    if inverse is not None:
        texts.append(
            f"Its stable inverse looks {inverse.preview} samples ahead. Noise of the output grows "
            f"by {inverse.noise_gain:.3g} (white), at most by {inverse.max_gain:.3g} at "
            f"{inverse.max_gain_frequency:.4g} Hz."
        )
    return Section(
        heading="The dynamics",
        texts=tuple(texts),
        table=dynamics_table(found),
        picture="dynamics.png",
        png=draw_dynamics(found),
        caption="Frequency response of G with its 95 % band"
        + ("." if found.first_dynamics is None else ", and that of the impulse response."),
        files={RESPONSE: found.frequency_response().to_csv().encode()},
        leads=True,
    )


def _how_known(found: IdentifiedHammerstein) -> tuple[str, ...]:
    if found.known.is_held:
        return ()
    undetermined = (
        "The drive does not determine an impulse response, so none is shown; the fit does not "
        "start from one.",
    )
    return (
        f"The drive shows G {bands_told(found.known)}. Standard errors and band count the noise "
        "and not what a model of too low an order leaves out; where the drive has no power within "
        "an octave (shaded), the response is an extrapolation by the model.",
        *(undetermined if found.markov is None else ()),
    )


def _in_continuous_time(found: IdentifiedHammerstein) -> tuple[str, ...]:
    continuous, reason = continuous_of(found.dynamics)
    if continuous is None:
        return (f"There is no continuous system whose sampled form it is: {reason}.",)
    late = f" and a dead time of {continuous.delay:.6g} s" if continuous.delay else ""
    polynomials = "; ".join(" ".join(each.split()) for each in polynomials_told(continuous))
    return (
        "It is the sampled form, for an input held between samples, of the continuous system with "
        f"{polynomials} (descending powers of s, rad/s){late}.",
    )


def _loop(found: IdentifiedHammerstein) -> Section:
    return Section(
        heading="The loop without a model of it",
        texts=(
            "The signal behind the hysteresis was estimated from the output alone, by the inverse "
            f"of G; noise blurs it by +- {found.loop.band:.3g} (two standard deviations).",
            "A drive of many frequencies makes a cloud of it. Record sines of one amplitude and "
            "run hyst loop: it draws one loop and tests whether the frequency moves it.",
        ),
        table=Table("Loop", ("samples shown", "band"), (_loop_row(found),)),
        picture="estimated_loop.png",
        png=draw_estimated_loop(found),
        caption="Estimated signal behind the hysteresis over the input, a branch a panel: samples, "
        "their mean with two standard deviations to either side, and the fitted hysteresis.",
        leads=True,
    )


def _loop_row(found: IdentifiedHammerstein) -> tuple[str, str]:
    valid = found.loop.valid
    return str(valid.stop - valid.start), number(found.loop.band)


@drawn
def draw_impulse_response(found: IdentifiedHammerstein, markov: MarkovParameters) -> Figure:
    """Draw step 1 and the singular values of step 2, as PNG.

    Parameters
    ----------
    found
        The result.
    markov
        Step 1.
    """
    figure, (response, singular) = blank(2, 1, 10.0, 3.9)
    scale = _scale(found, markov)
    lags = np.arange(markov.order + 1)
    response.errorbar(
        lags,
        scale * markov.values,
        yerr=2.0 * abs(scale) * markov.standard_errors,
        fmt=".",
        color=MEASURED,
        label="least squares",
    )
    refined = found.dynamics.impulse_response(markov.order + 1)
    response.plot(lags, refined, "o", fillstyle="none", color=MODELLED, label="refined G")
    response.set_title("Impulse response of G")
    response.set_xlabel("samples")
    response.legend()
    values = found.singular_values
    singular.semilogy(np.arange(1, values.size + 1), values, "o", color=SECOND)
    if found.hankel_noise > 0.0:
        singular.axhline(found.hankel_noise, color=FAINT, label="errors of the response")
        singular.legend()
    singular.axvline(found.dynamics.order + 0.5, color=MODELLED, linestyle="--")
    singular.set_title("Singular values, order chosen")
    singular.set_xlabel("number")
    return figure


@drawn
def draw_estimated_loop(found: IdentifiedHammerstein) -> Figure:
    """Draw the nonparametric loop, a branch a panel, with the fitted hysteresis over it, as PNG."""
    figure, panels = blank(2, 1, 10.0, 4.4)
    loop, about = found.loop, found.description
    valid = slice(loop.valid.start, min(loop.valid.stop, loop.valid.start + _MOST_POINTS))
    fitted = found.hysteresis(loop.u[: valid.stop])[valid]
    u, v = loop.u[valid], loop.v[valid]
    rising = np.gradient(u) >= 0.0
    for axes, branch, name in zip(panels, (rising, ~rising), ("rising", "falling"), strict=True):
        axes.plot(u[branch], v[branch], ".", markersize=1.5, color=FAINT, label="estimated")
        axes.plot(u[branch], fitted[branch], ".", markersize=1.5, color=MODELLED, label="fitted")
        centres, mean, deviation = branch_band(u[branch], v[branch])
        axes.plot(centres, mean, color=SECOND, label="mean of the estimated")
        for side, label in ((-2.0, None), (2.0, "two standard deviations")):
            axes.plot(centres, mean + side * deviation, "--", color=SECOND, label=label)
        axes.set_xlabel(with_unit(about.input_name, about.input_unit))
        axes.set_ylabel(with_unit("signal behind the hysteresis", about.output_unit))
        axes.set_title(f"Input {name}")
        # Single samples far off, in a noisy record, must not flatten the loop.
        axes.set_ylim(*_shown_range(v, fitted))
    panels[0].legend(markerscale=4.0, loc="upper left")
    return figure


def branch_band(u: Array, v: Array) -> tuple[Array, Array, Array]:
    """Give mean and standard deviation of a signal in bins of the input.

    Parameters
    ----------
    u, v
        Shape (N,): input and signal of one branch, in any order.

    Returns
    -------
    centres, mean, deviation : numpy.ndarray
        Shape (bins,); bins of less than eight samples are left out.

    Examples
    --------
    >>> centres, mean, deviation = branch_band(np.repeat([0.0, 1.0], 8), np.repeat([2.0, 3.0], 8))
    >>> mean.tolist(), deviation.tolist()
    ([2.0, 3.0], [0.0, 0.0])
    """
    if u.size == 0 or np.ptp(u) == 0.0:
        return np.empty(0), np.empty(0), np.empty(0)
    edges = np.linspace(u.min(), u.max(), _BINS + 1)
    places = np.clip(np.searchsorted(edges, u, side="right") - 1, 0, _BINS - 1)
    count = np.bincount(places, minlength=_BINS)
    filled = count >= _LEAST_IN_BIN
    share = np.maximum(count, 1)
    mean = np.bincount(places, v, _BINS) / share
    variance = np.bincount(places, np.square(v - mean[places]), _BINS) / share
    centres = 0.5 * (edges[1:] + edges[:-1])
    return centres[filled], mean[filled], np.sqrt(variance[filled])


def _shown_range(v: Array, fitted: Array) -> tuple[float, float]:
    low, high = np.quantile(v, [0.001, 0.999])
    low, high = min(low, fitted.min()), max(high, fitted.max())
    margin = 0.05 * max(high - low, np.finfo(np.float64).tiny)
    return float(low - margin), float(high + margin)


def _scale(found: IdentifiedHammerstein, markov: MarkovParameters) -> float:
    """Factor that brings the first step to DC gain 1, by least squares on the refined response."""
    h = found.dynamics.impulse_response(markov.order + 1)
    m = markov.values
    return float(m @ h) / float(m @ m)
