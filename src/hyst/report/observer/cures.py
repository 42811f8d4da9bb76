"""What to change where a block is not safe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hyst.control import EXACT
from hyst.report.observer.words import hertz
from hyst.report.table import number

if TYPE_CHECKING:
    from hyst.report.observer.answer import ObserverAnswer


def cure_of(answer: ObserverAnswer) -> str:
    """Say what to change; of the block that failed, whatever its design promised.

    Parameters
    ----------
    answer
        One that is not safe.

    Returns
    -------
    str
        One or two sentences.
    """
    c, margin = answer.certificate, answer.margin_of_design
    if c.robustly_stable:
        return _cure_of_the_rest(answer)
    if not c.nominal_stable and answer.margins is not None and not answer.margins[0].stable:
        return (
            "The controller alone does not stabilize the nominal plant as it runs, "
            f"{answer.sampled()}: lower its gain, or let it be designed, "
            '[controller] kind = "auto".'
        )
    if margin is not None and margin > 1.0:
        by = "sampling and delay break it" if c.delay else "sampling breaks it"
        return (
            f"The design in continuous time would hold (Wu may grow {margin:.3g} times): "
            f'{by}. Give [design] time = "discrete", a shorter [filter] dt, or a '
            "Wp that asks for less."
        )
    return f"The design: {answer.design.message}."


def _cure_of_the_rest(answer: ObserverAnswer) -> str:
    """Say what to change where the block itself is stable for every plant within Wu."""
    true = answer.true_plant
    if true is not None and not true.within:
        return (
            f"The true plant is off by up to {number(true.used)} |Wu|, at "
            f"{hertz(true.frequency)}: give a Wu that holds it, and design again."
        )
    failing = answer.failing_slope()
    if failing is None and answer.loop.diverged_at is None:
        return (
            "A plant that Wu allows breaks it at the edge of what was computed: give a larger Wu."
        )
    if failing is None:
        return (
            "No slope that it met is unstable, and yet the simulation diverges: see if the "
            "actuator can reach the reference, and tell the block what its drive may be, "
            "[limits] drive."
        )
    closer = "" if answer.inverse_name == EXACT else "an inverse closer to the exact one, or "
    return (
        f"The block is stable where the inverse is exact; with this one ({answer.inverse_name}) "
        f"hysteresis and inverse make a gain of {failing:.3g}, at which it is not. Give "
        f"{closer}a controller of lower gain."
    )
