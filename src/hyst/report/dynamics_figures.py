"""Sections of a report on dynamics identified behind a hysteresis."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from hyst.identification import Identified
from hyst.identification.hammerstein.identified_hammerstein import IdentifiedHammerstein
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit
from hyst.report.identification_report import Section
from hyst.report.tables import Table, number

_MOST_POINTS = 20_000


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
    sections = [_response(found), _dynamics(found)]
    if found.loop.valid.stop > found.loop.valid.start:
        sections.append(_loop(found))
    return tuple(sections)


def _response(found: IdentifiedHammerstein) -> Section:
    markov = found.markov
    return Section(
        heading="First step: the impulse response",
        texts=(
            f"Least squares on {markov.samples} samples with {markov.order + 1} lags; condition of "
            f"the regressors {markov.condition:.3g}. Bars are two standard errors; they count the "
            "distortion by the hysteresis as noise. The order was cut where the singular values of "
            "the Hankel matrix sink into the errors, or before, where a further state did not "
            "lower the simulated error.",
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
        png=draw_impulse_response(found),
        caption="Markov parameters, and singular values of their Hankel matrix.",
    )


def _dynamics(found: IdentifiedHammerstein) -> Section:
    rows = tuple(
        (
            f"{pole.real:+.6g} {pole.imag:+.6g}j",
            f"{error.real:.2g}, {error.imag:.2g}",
            number(abs(float(np.angle(pole))) / (2.0 * np.pi * found.dynamics.dt)),
        )
        for pole, error in zip(found.poles, found.pole_standard_errors, strict=True)
    )
    inverse = found.inverse_of_dynamics
    texts = [
        "G carries no gain of its own: its gain at rest is 1, because input and output determine "
        "only the product with the hysteresis."
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
        table=Table("Poles of G", ("pole", "standard errors", "frequency [Hz]"), rows),
        picture="dynamics.png",
        png=draw_dynamics(found),
        caption="Frequency response of G, before and after the refinement.",
    )


def _loop(found: IdentifiedHammerstein) -> Section:
    return Section(
        heading="The loop without a model of it",
        texts=(
            "The signal behind the hysteresis was estimated from the output alone, by the inverse "
            f"of G; noise blurs it by +- {found.loop.band:.3g} (two standard deviations).",
        ),
        table=Table("Loop", ("samples shown", "band"), (_loop_row(found),)),
        picture="estimated_loop.png",
        png=draw_estimated_loop(found),
        caption="Estimated signal behind the hysteresis over the input, and the fitted hysteresis.",
    )


def _loop_row(found: IdentifiedHammerstein) -> tuple[str, str]:
    valid = found.loop.valid
    return str(valid.stop - valid.start), number(found.loop.band)


@drawn
def draw_impulse_response(found: IdentifiedHammerstein) -> Figure:
    """Draw step 1 and the singular values of step 2, as PNG."""
    figure, (response, singular) = blank(2, 1, 10.0, 3.9)
    markov = found.markov
    scale = _scale(found)
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
def draw_dynamics(found: IdentifiedHammerstein) -> Figure:
    """Draw the frequency response of G, as PNG."""
    figure, (gain, phase) = blank(2, 1, 10.0, 3.9)
    nyquist = 0.5 / found.dynamics.dt
    frequency = np.geomspace(1e-3 * nyquist, 0.999 * nyquist, 600)
    for G, color, label in (
        (found.first_dynamics, MEASURED, "realized"),
        (found.dynamics, MODELLED, "refined"),
    ):
        response = G.frequency_response(frequency)
        gain.loglog(frequency, np.abs(response), color=color, label=label)
        phase.semilogx(frequency, np.degrees(np.unwrap(np.angle(response))), color=color)
    gain.set_title("Gain of G")
    phase.set_title("Phase of G [degrees]")
    gain.set_xlabel("frequency [Hz]")
    phase.set_xlabel("frequency [Hz]")
    gain.legend()
    return figure


@drawn
def draw_estimated_loop(found: IdentifiedHammerstein) -> Figure:
    """Draw the nonparametric loop with the fitted hysteresis over it, as PNG."""
    figure, (axes,) = blank(1, 1, 6.5, 4.6)
    loop, about = found.loop, found.description
    valid = slice(loop.valid.start, min(loop.valid.stop, loop.valid.start + _MOST_POINTS))
    fitted = found.hysteresis(loop.u[: valid.stop])[valid]
    axes.plot(loop.u[valid], loop.v[valid], ".", markersize=1.5, color=MEASURED, label="estimated")
    axes.plot(loop.u[valid], fitted, ".", markersize=1.0, color=MODELLED, label="fitted")
    axes.set_xlabel(with_unit(about.input_name, about.input_unit))
    axes.set_ylabel(with_unit("signal behind the hysteresis", about.output_unit))
    axes.legend(markerscale=6.0)
    return figure


def _scale(found: IdentifiedHammerstein) -> float:
    """Factor that brings the first step to DC gain 1, by least squares on the refined response."""
    h = found.dynamics.impulse_response(found.markov.order + 1)
    m = found.markov.values
    return float(m @ h) / float(m @ m)
