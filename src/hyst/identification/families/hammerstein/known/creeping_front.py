"""Hysteresis that creeps before dynamics: a family with lags behind it, at the front of another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.creep.creeping_family import CreepingFamily
from hyst.identification.creep.joint_fit import IDLE
from hyst.identification.creep.told import SLOW
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Family, Fit, Start
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import signal_behind
from hyst.identification.families.hammerstein.joint import dynamics_of, joint, joint_of
from hyst.identification.families.hammerstein.known.creep_guess import (
    CreepGuess,
    guess_of_creep,
    slowest_real,
    without_slow_poles,
)
from hyst.identification.families.hammerstein.known.held_front import HeldFront
from hyst.identification.families.hammerstein.known.held_joint import joint_held
from hyst.identification.families.hammerstein.known.known_start import (
    fronts_before,
    signal_of_plays,
)
from hyst.identification.families.hammerstein.start.dense_plays import dense_plays
from hyst.identification.families.staged_family import StagedFamily
from hyst.identification.fit.nuisance import Nuisances, Settling
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.stages import StagedParametrization, with_part, with_stage
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import Creep, LinearDynamics

Array = NDArray[np.float64]

LARGEST_WEIGHT = 1.0
"""Of a lag: what adds more than the signal itself is dynamics."""

CLOSE = 3.0
"""Between time constants of a lag and of a real pole: nearer ones do the same."""


@final
@dataclass(frozen=True)
class CreepingFront(StagedFamily):
    """A family with lags behind its hysteresis, before dynamics; it is in no registry.

    Parameters
    ----------
    base
        The family of the hysteresis.
    lags
        How many.
    """

    lags: int = 1

    @property
    def _creeping(self) -> CreepingFamily:
        return CreepingFamily(self.base)

    def sizes(self) -> tuple[int, ...]:
        """Give the sizes of the hysteresis."""
        return self.base.sizes()

    def least_parameters(self, size: int) -> int:
        """Give those of the hysteresis, and two of each lag."""
        return self.base.least_parameters(size) + 2 * self.lags

    def refused_before_dynamics(self) -> str:
        """Say what the hysteresis' family says."""
        return self.base.refused_before_dynamics()

    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Fit the options of the hysteresis to the records."""
        base, notes = self.base.suited(data)
        return replace(self, base=base), notes

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with options of the hysteresis in other units."""
        return replace(self, base=self.base.in_units(input_scale, output_scale))

    def finish(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Improve the hysteresis as its own family knows; its parameters come first of all."""
        whole = fit.parametrization
        assert isinstance(whole, StagedParametrization), "lags were put in"
        taken = {each.name: getattr(whole, each.name) for each in fields(Parametrization)}
        seen = replace(fit, family=self.base, parametrization=replace(whole.base, **taken))
        return replace(fit, solution=self.base.finish(seen, overview, max_iterations).solution)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what the family of the hysteresis says."""
        return self._creeping.notes(fit, data)

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants of the hysteresis, then weights and time constants."""
        return self._creeping.estimates(fit)


def creeping_starts(
    front: CreepingFront,
    dynamics: LinearDynamics,
    data: Data,
    size: int,
    again: Callable[[HeldFront], LinearDynamics] | None,
) -> Sequence[Start]:
    """Give hysteresis, creep and dynamics to start from, the best first.

    Parameters
    ----------
    front
        The family of the hysteresis and the number of lags.
    dynamics
        Found without creep, or known; of gain 1 at rest.
    data
        The records.
    size
        One of the sizes of the hysteresis.
    again
        Finds dynamics behind a known hysteresis; None where they are known.

    Raises
    ------
    NotIdentifiableError
        If the records do not show this hysteresis.
    """
    held = again is None
    guess = guess_of_creep(data, dynamics, front.lags, held)
    if again is not None:
        # A lag that nobody knew of was made up for by further poles.
        found = again(_hysteresis_of(data, guess))
        fast = without_slow_poles(found, guess.bounds[0], found.order)
        guess = replace(guess, dynamics=fast)
    together = guess.together()
    signals = [signal_of_plays(data, together), _before_creep(data, guess)]
    fronts = fronts_before(front.base, together, signals, data, size)
    return [_creeping(each, guess, held, data) for each in fronts]


def _hysteresis_of(data: Data, guess: CreepGuess) -> HeldFront:
    """Give plays that creep, as the records have them."""
    plays = dense_plays(data, guess.together())
    stage = Creep(guess.weights, guess.time_constants, guess.dynamics.dt)
    return HeldFront(with_part(plays, stage, "output"))


def _before_creep(data: Data, guess: CreepGuess) -> Data:
    """Give the records of the hysteresis alone, back through dynamics and creep."""
    behind = signal_behind(data, guess.dynamics)
    undone = Creep(guess.weights, guess.time_constants, guess.dynamics.dt).inverse()
    records = tuple(
        replace(each, y=undone(each.y - each.y[0]) + each.y[0]) for each in behind.records
    )
    return replace(behind, records=records)


def _creeping(front: Start, guess: CreepGuess, held: bool, data: Data) -> Start:
    """Put lags behind a hysteresis and dynamics behind them."""
    base, theta = front
    count = guess.weights.size
    stage = Creep(guess.weights, guess.time_constants, guess.dynamics.dt)
    lower = np.repeat([0.0, guess.bounds[0]], count)
    upper = np.repeat([LARGEST_WEIGHT, guess.bounds[1]], count)
    staged = with_stage(base, theta, stage, "output", lower, upper)
    return joined(staged, guess.dynamics, held)


def joined(front: Start, dynamics: LinearDynamics, held: bool) -> Start:
    """Give the free parameters of a hysteresis, of its creep if it has any, and of dynamics.

    What lags still do of their state before each record is fitted beside them.

    Parameters
    ----------
    front
        The hysteresis, with lags or without.
    dynamics
        Behind it, of gain 1 at rest.
    held
        Whether they are known.
    """
    made, theta = (joint_held if held else joint)(front, dynamics)
    own = front[0]
    if not isinstance(own, StagedParametrization):
        return made, theta
    count = (own.size - own.base.size) // 2
    places = tuple(range(own.base.size + count, own.size))
    beside = () if made.nuisances is None else made.nuisances.parts
    return replace(made, nuisances=Nuisances((*beside, Settling(places)))), theta


def told_of_creep(fit: Fit, data: Data) -> tuple[str, ...]:
    """Say how creep and dynamics were told apart, and where they cannot be.

    Parameters
    ----------
    fit
        Of a hysteresis that creeps before dynamics.
    data
        The records.
    """
    staged, G = joint_of(fit).front, dynamics_of(fit)
    assert isinstance(staged, StagedParametrization), "lags were put in"
    own = fit.solution.theta[staged.base.size : staged.size]
    times = np.sort(own[own.size // 2 :])
    listed = ", ".join(f"{each:.3g}" for each in times)
    slow = slowest_real(G)
    pole = f"its slowest real pole has {slow:.3g} s" if slow else "it has no real pole that decays"
    idle = int(np.count_nonzero(own[: own.size // 2] <= IDLE))
    notes = [f"{idle} of {times.size} lags of creep came out with no weight"] if idle else []
    notes += [
        f"creep of time constants {listed} s stands between hysteresis and dynamics: lags are "
        f"slower than {float(staged.lower[-1]):.3g} s; what is faster is the dynamics', and {pole}"
    ]
    longest = max(record.duration for record in data.records)
    if times[-1] > SLOW * longest:
        notes.append(
            f"a lag of {times[-1]:.3g} s is as slow as the longest record, {longest:.3g} s, is "
            "long, so neither it nor its weight is known; record for longer, or give fewer lags"
        )
    if slow > times[0] / CLOSE:
        notes.append(
            f"a pole of the dynamics with a time constant of {slow:.3g} s does what a lag "
            "does, so neither is told from the other; give fewer lags or a lower state_order"
        )
    return tuple(notes)


def as_creeping(family: Family, lags: int) -> Family:
    """Give a family with lags behind its hysteresis."""
    return CreepingFront(base=family, lags=lags)
