"""Tables of the answer of an observer, the same for the terminal and for the page."""

from __future__ import annotations

import numpy as np

from hyst.control import DisturbanceObserver, SampledCertificate, TriedLoop
from hyst.report.observer.answer import ObserverAnswer
from hyst.report.observer.feedback_tables import margins_table, parts_table
from hyst.report.observer.words import STANDINGS, bandwidth_told, hertz, rightmost, told
from hyst.report.table import Table, number

THIS = "this block"


def answer_tables(answer: ObserverAnswer) -> tuple[Table, ...]:
    """Give the four tables of an answer: safety, tracking, other designs, what it is.

    Parameters
    ----------
    answer
        Of ``hyst observer``.

    Returns
    -------
    tuple of Table
    """
    first = checks_table(answer), tracking_table(answer), *feedback_tables(answer)
    return *first, rivals_table(answer), filter_table(answer)


def feedback_tables(answer: ObserverAnswer) -> tuple[Table, ...]:
    """Give what is known of C: its margins, and what each part of the loop is worth.

    Parameters
    ----------
    answer
        Of ``hyst observer``.

    Returns
    -------
    tuple of Table
    """
    worth = () if answer.parts is None else (parts_table(answer.parts),)
    if answer.margins is None:
        return worth
    alone, block = answer.margins
    whole = block if answer.has_observer else None
    return *worth, margins_table(alone, whole, answer.controller_design)


def checks_table(answer: ObserverAnswer) -> Table:
    """List the conditions of safety, and what else is known beside them.

    Parameters
    ----------
    answer
        Of ``hyst observer``.

    Returns
    -------
    Table
    """
    rows = [(what, "yes" if holds else "NO", said) for what, holds, said in answer.checks()]
    rows += _proof(answer) + _design(answer) + _true_plant(answer) + _range(answer)
    c = answer.certificate
    rows.append(
        (
            "rejects what Wp asks for",
            "yes" if answer.meets_demand else "NO",
            f"Wp E {number(c.performance_norm)} at {hertz(c.performance_frequency)}",
        )
    )
    robust = f"{number(c.robust_performance)} at {hertz(c.robust_performance_frequency)}"
    rows.append(
        (
            "rejects it for every plant within Wu",
            "yes" if c.robust_performance < 1.0 else "no",
            f"|Wp E| + |Wu T| {robust}",
        )
    )
    title = f"Is the loop safe? Of the block, {answer.sampled()}"
    return Table(title, ("condition", "holds", "by"), tuple(rows))


def _proof(answer: ObserverAnswer) -> list[tuple[str, str, str]]:
    j = answer.judgement
    if j.slopes is None:
        what = "proven for all slopes of this inverse"
        return [(what, "open", "they are known for plays between maps alone")]
    low, high = j.slopes
    what = f"proven for slopes {low:.3g} to {high:.3g} of this inverse"
    if j.proof is None:
        return [(what, "open", "the simulation diverges")]
    said = f"circle criterion {number(j.proof)}, below 1 for a proof"
    return [(what, "yes" if answer.proven_with_inverse else "open", said)]


def _design(answer: ObserverAnswer) -> list[tuple[str, str, str]]:
    """Tell the margin of the design in continuous time beside that of the block."""
    margin = answer.margin_of_design
    if margin is None:
        return []
    own = answer.design.certificate
    said = f"Wu T {number(own.uncertainty_norm)} at {hertz(own.uncertainty_frequency)}"
    what = "(the design, in continuous time, would be)"
    return [(what, "yes" if margin > 1.0 else "no", said)]


def _true_plant(answer: ObserverAnswer) -> list[tuple[str, str, str]]:
    true = answer.true_plant
    if true is None:
        return []
    said = f"|P / Pn - 1| up to {number(true.used)} |Wu|, at {hertz(true.frequency)}"
    return [("true plant is within Wu", "yes" if true.within else "NO", said)]


def _range(answer: ObserverAnswer) -> list[tuple[str, str, str]]:
    if answer.identified is None:
        return []
    what = "drive stays where the model was identified, {} to {}".format(
        *map(number, answer.identified)
    )
    holds = "yes" if answer.within_identified else "NO"
    return [(what, holds, "{} to {}".format(*map(number, answer.drive_range)))]


def tracking_table(answer: ObserverAnswer) -> Table:
    """List tracking errors by inverse, without and with the observer, and if each loop is safe.

    Parameters
    ----------
    answer
        Of ``hyst observer``.

    Returns
    -------
    Table
    """
    rows: list[tuple[str, ...]] = []
    marked = 0
    for name in answer.observed:
        kinds = [("no", answer.without)]
        if answer.has_observer:
            kinds.append(("yes", answer.observed))
        for observer, of in kinds:
            if name == answer.inverse_name:
                marked = len(rows)
            rows.append(_tracked(name, observer, of[name]))
    return Table(
        f"{'What does the observer buy?' if answer.has_observer else 'How does it track?'} "
        f"The loop, {answer.sampled()}",
        ("inverse", "observer", "rms error", "max error", "drive, jump a sample", "safe?"),
        tuple(rows),
        marked,
    )


def _tracked(name: str, observer: str, tried: TriedLoop) -> tuple[str, ...]:
    loop = tried.loop
    return (
        name,
        observer,
        told(loop.rms_error),
        told(loop.max_error),
        told(loop.drive_jitter),
        STANDINGS[tried.judgement.standing],
    )


def rivals_table(answer: ObserverAnswer) -> Table:
    """Compare the block with simpler ones for the same plant and weights.

    Parameters
    ----------
    answer
        Of ``hyst observer``.

    Returns
    -------
    Table
    """
    blocks = {**answer.rivals, THIS: answer.certificate}
    rows = tuple((name, *_certified(each)) for name, each in blocks.items())
    return Table(
        "Is a simpler one as good?",
        ("block", "stacked", "Wu T", "Wp E", "rejects up to", "noise to v", "jump of v a sample"),
        rows,
        len(rows) - 1,
    )


def _certified(c: SampledCertificate) -> tuple[str, ...]:
    if not c.nominal_stable:
        return ("unstable", "-", "-", "-", "-", "-")
    return (
        number(c.stacked_norm),
        number(c.uncertainty_norm),
        number(c.performance_norm),
        bandwidth_told(c.rejection_bandwidth).split(",")[0],
        number(c.noise_gain),
        number(c.noise_jitter),
    )


def _least(design: DisturbanceObserver) -> str:
    """Write the lower bounds of a design, with the noise that they cost."""
    said = f"{number(design.lower_bound)}, at any noise"
    if design.lower_bound_at_noise is None:
        return said
    return f"{number(design.lower_bound_at_noise)} at this noise gain; {said}"


def filter_table(answer: ObserverAnswer) -> Table:
    """List what the observer is: its gain, Q(s) and its poles.

    Parameters
    ----------
    answer
        Of ``hyst observer``.

    Returns
    -------
    Table
    """
    c = answer.certificate
    rows: list[tuple[str, str]] = [
        ("rejects disturbances up to", bandwidth_told(c.rejection_bandwidth)),
        (
            "fastest pole",
            f"{hertz(c.fastest_pole)}; half the sample rate is {hertz(c.nyquist)}",
        ),
        (
            "sensor noise of 1, white",
            f"v: {number(c.noise_rms)}, its jump from sample to sample: {number(c.noise_jitter)}; "
            f"at most {number(c.noise_gain)} at {hertz(c.noise_frequency)}",
        ),
    ]
    if answer.noise:
        tried = answer.observed[answer.inverse_name]
        rows.append(
            (
                f"sensor noise of {number(answer.noise)}",
                f"drive: {number(tried.noise_in_drive)}, its jump: {number(tried.noise_jitter)}",
            )
        )
    if answer.bound is not None:
        rows.append(
            (
                "error of the inverse",
                f"command off by at most {number(answer.bound.bound)}, its output by at most "
                f"{number(answer.bound.output_bound)}, for |v| up to {number(answer.bound.y_max)}",
            )
        )
    rows += _of_design(answer)
    return Table("What is it?", ("what", "value"), tuple(rows))


def _of_design(answer: ObserverAnswer) -> list[tuple[str, str]]:
    """List what the block was sampled from; one that was designed as it runs has a gain alone."""
    gain = getattr(answer.design, "gain", None)
    rows = [] if gain is None else [("gain L", ", ".join(number(each, 8) for each in gain))]
    if answer.margin_of_design is None:
        return rows
    own, nyquist = answer.design.certificate, answer.certificate.nyquist
    fastest = float(np.abs(own.observer_poles).max(initial=0.0))
    beyond = "" if fastest < nyquist else ": too fast for this sample time"
    rows += [
        ("Q(s) numerator", ", ".join(number(each, 8) for each in own.Q_numerator)),
        ("Q(s) denominator", ", ".join(number(each, 8) for each in own.Q_denominator)),
        ("fastest pole of Q(s)", f"{hertz(fastest)}{beyond}"),
        ("slowest pole of Q(s)", f"{rightmost(own.observer_poles)} 1/s"),
        ("no observer of any order has a norm below", _least(answer.design)),
    ]
    return [(f"continuous design: {what}", value) for what, value in rows]
