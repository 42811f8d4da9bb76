"""Where fits start of which something is known: dynamics, hysteresis, or that it creeps."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from hyst.identification.families.family import Family, Start
from hyst.identification.families.hammerstein.joint import joint
from hyst.identification.families.hammerstein.known.creeping_front import (
    CreepingFront,
    creeping_starts,
)
from hyst.identification.families.hammerstein.known.given_dynamics import GivenDynamics
from hyst.identification.families.hammerstein.known.held_front import HeldFront
from hyst.identification.families.hammerstein.known.known_front import starts_behind_known
from hyst.identification.families.hammerstein.known.known_start import (
    fronts_before,
    held_dynamics,
    signal_of_plays,
    starts_of_known,
)
from hyst.identification.record_use.one_sample_time import finest
from hyst.identification.record_use.overview import Overview
from hyst.models import LinearDynamics


def known_starts(
    known: tuple[HeldFront | None, GivenDynamics | None],
    hysteresis: Family,
    overview: Overview,
    size: int,
    first: Callable[[HeldFront | None], LinearDynamics],
) -> Sequence[Start] | None:
    """Give where to start; None where it is found as for one record of which nothing is known.

    Parameters
    ----------
    known
        Hysteresis and dynamics, each None where it is not known.
    hysteresis
        Family in front.
    overview
        The records.
    size
        One of the sizes of the hysteresis.
    first
        Finds dynamics that are not known, behind a hysteresis that is or is not.

    Raises
    ------
    NotIdentifiableError
        If the records do not show the hysteresis.
    """
    front, given = known
    held = None
    if given is not None:
        held = overview.once(("held", given), lambda: held_dynamics(given, overview))
    if isinstance(hysteresis, CreepingFront):
        dynamics, again = (first(front), first) if held is None else (held, None)
        return creeping_starts(hysteresis, dynamics, overview.data, size, again)
    if held is not None:
        return starts_of_known(hysteresis, held, overview.data, size)
    if front is not None:
        return starts_behind_known(front, first(front), overview.data)
    if finest(overview) is overview:
        return None
    # Those that were measured at every sample showed the dynamics; all show the hysteresis.
    dynamics = first(None)
    signals = [signal_of_plays(overview.data, dynamics)]
    fronts = fronts_before(hysteresis, dynamics, signals, overview.data, size)
    return [joint(each, dynamics) for each in fronts]
