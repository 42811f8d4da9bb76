"""All findings, in the order in which they are told and looked for.

A finding is one file of ``hyst.diagnosis.findings`` with a function ``find`` and one line here.
Those that concern values which are no measurements come first, for the later ones pass those over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings import (
    butterfly,
    codes,
    delay_or_radius,
    direction,
    disagreement,
    drifting_output,
    driven,
    dropouts,
    dynamics,
    foreign_lines,
    gain_sign,
    levels_left_out,
    loop_size,
    next_record,
    noise_floor,
    one_amplitude,
    outliers,
    output_ahead,
    output_is_noise,
    quantisation,
    rate_dependence,
    saturated_sensor,
    step_change,
    still_signals,
    wrapped_counter,
)

Finder = Callable[[Evidence], Iterable[Finding]]

FINDERS: tuple[Finder, ...] = (
    codes.find,
    still_signals.find,
    wrapped_counter.find,
    dropouts.find,
    outliers.find,
    saturated_sensor.find,
    output_is_noise.find,
    quantisation.find,
    step_change.find,
    drifting_output.find,
    butterfly.find,
    direction.find,
    foreign_lines.find,
    disagreement.find,
    rate_dependence.find,
    dynamics.find,
    levels_left_out.find,
    one_amplitude.find,
    driven.find,
    loop_size.find,
    noise_floor.find,
    gain_sign.find,
    next_record.find,
)
FINDERS_OF_DELAY: tuple[Finder, ...] = (output_ahead.find, delay_or_radius.find)
"""An identification, which asks for the delay anyway, does without them: see ``with_delay``."""
