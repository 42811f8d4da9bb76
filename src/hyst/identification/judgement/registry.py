"""All causes of what a fit leaves, from the simplest to the most general.

A cause is one file of ``hyst.identification.judgement.causes`` and one line here. Of two that
explain about the same the first is told. Sines and outliers are looked for by themselves.
"""

from __future__ import annotations

from hyst.identification.judgement.cause import Cause
from hyst.identification.judgement.causes.another_shape import ANOTHER_SHAPE
from hyst.identification.judgement.causes.change import CHANGE
from hyst.identification.judgement.causes.creep import CREEP
from hyst.identification.judgement.causes.drift import DRIFT
from hyst.identification.judgement.causes.dynamics import DYNAMICS
from hyst.identification.judgement.causes.lag import LAG
from hyst.identification.judgement.causes.rate import RATE
from hyst.identification.judgement.causes.records_differ import RECORDS_DIFFER
from hyst.identification.judgement.causes.sine import SINE
from hyst.identification.judgement.causes.wander import WANDER
from hyst.identification.judgement.causes.zeros import ZEROS

CAUSES: tuple[Cause, ...] = (
    DRIFT,
    LAG,
    SINE,
    ZEROS,
    CHANGE,
    RATE,
    CREEP,
    RECORDS_DIFFER,
    DYNAMICS,
    WANDER,
    ANOTHER_SHAPE,
)
"""One cause a file."""
