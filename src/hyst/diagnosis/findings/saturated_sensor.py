"""Finding: a sensor at its end."""

from __future__ import annotations

from collections.abc import Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.values.measured import Values, values_of_each
from hyst.diagnosis.values.plateaus import Plateau
from hyst.diagnosis.values.wording import amount, samples_counted, subject

NAME = "saturated sensor"


def find(evidence: Evidence) -> Iterable[Finding]:
    """Tell levels at which the output stands while the input goes on and comes back.

    At about zero the actuator may as well have a dead zone, so samples there are kept.
    """
    for values in values_of_each(evidence):
        for plateau in values.plateaus:
            yield _finding(evidence, values, plateau)


def _finding(evidence: Evidence, values: Values, plateau: Plateau) -> Finding:
    level = amount(plateau.level, values.record.output_unit)
    moved = amount(plateau.moved, values.record.input_unit)
    doubtful = values.is_doubtful(plateau)
    end = "its upper end" if plateau.is_upper else "its lower end"
    cause = f"the sensor is at {end}" + (", or the actuator has a dead zone" if doubtful else "")
    if doubtful:
        advice = "If it is the sensor, cut these samples out; a model of the rest would be wrong."
    else:
        side = "above" if plateau.is_upper else "below"
        advice = (
            f"What a model says about outputs {side} {level} is extrapolation; choose a larger "
            "range of the sensor, or drive less."
        )
    return Finding(
        NAME,
        "warning" if doubtful else "left out",
        f"{subject(evidence, values.number, 'output')} stands at {level} for "
        f"{samples_counted(plateau.samples.size)} while the input moves by up to {moved}: {cause}.",
        advice,
        values.number,
        plateau.samples,
        {"level": plateau.level, "count": float(plateau.samples.size), "moved": plateau.moved},
    )
