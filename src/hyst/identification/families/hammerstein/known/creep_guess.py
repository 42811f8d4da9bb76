"""Where creep before dynamics starts: apart from the dynamics, and from the hysteresis.

A lag that creeps and a slow real pole of the dynamics are the same to an output. So the dynamics
give up their slow real poles, the lags are found anew beside plays before what is left, and from
then on lags are slower, poles faster than a time between the two.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.creep.evidence import LARGEST, evenly
from hyst.identification.creep.lags import answers, bounds_of, in_use
from hyst.identification.creep.merging import merged
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import (
    of_gain_one,
    shortened,
)
from hyst.identification.families.hammerstein.known.known_start import (
    best_weights,
    filtered_by,
    plays_of,
)
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.fit.projection import Basis
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

PER_DECADE = 4
FASTER = 3.0
"""Times the slowest real pole of the dynamics that are left: lags are slower."""

_MOST_SAMPLES = 100_000


@dataclass(frozen=True, eq=False)
class CreepGuess:
    """Creep to start from, and the dynamics behind it.

    Parameters
    ----------
    weights, time_constants
        Shape (n,), time constants ascending, s.
    bounds
        Shortest and longest time constant, s.
    dynamics
        Behind it, of gain 1 at rest.
    """

    weights: Array
    time_constants: Array
    bounds: tuple[float, float]
    dynamics: LinearDynamics

    def together(self) -> LinearDynamics:
        """Give creep and dynamics as one linear system, whose gain at rest is above 1."""
        G = self.dynamics
        kept = np.exp(-G.dt / self.time_constants)
        n, own = kept.size, G.order
        A = np.zeros((n + own, n + own))
        A[:n, :n], A[n:, n:] = np.diag(kept), G.A
        A[n:, :n] = np.outer(G.B, self.weights)
        B = np.concatenate([1.0 - kept, G.B])
        return LinearDynamics(A, B, np.concatenate([G.D * self.weights, G.C]), G.D, G.dt, G.delay)


def guess_of_creep(data: Data, dynamics: LinearDynamics, count: int, held: bool) -> CreepGuess:
    """Find lags beside the plays that explain the output best behind known dynamics.

    Parameters
    ----------
    data
        The records.
    dynamics
        Found without creep, of gain 1 at rest.
    count
        Of lags.
    held
        Whether the dynamics are known, so that none of their poles creeps.
    """
    shortest, longest = bounds_of(data)
    fast = dynamics if held else without_slow_poles(dynamics, shortest, count)
    bounds = min(max(shortest, FASTER * slowest_real(fast)), 0.1 * longest), longest
    tau = np.geomspace(*bounds, max(int(PER_DECADE * np.log10(bounds[1] / bounds[0])), 2 * count))
    weights = _weights_of_lags(data, fast, tau)
    heavy = weights > 0.0
    w, times = merged(weights[heavy], tau[heavy], count, bounds)
    return CreepGuess(w * min(LARGEST / max(w.sum(), LARGEST), 1.0), times, bounds, fast)


def slowest_real(dynamics: LinearDynamics) -> float:
    """Give the longest time constant of a real pole, s; 0 where there is none.

    Parameters
    ----------
    dynamics
        Stable.
    """
    poles = dynamics.poles()
    real = poles[(poles.imag == 0.0) & (poles.real > 0.0)].real
    return -dynamics.dt / float(np.log(real.max())) if real.size else 0.0


def without_slow_poles(dynamics: LinearDynamics, slow: float, most: int) -> LinearDynamics:
    """Give dynamics without the real poles that creep, of gain 1 at rest.

    Those are slow, and what they add to the gain at rest is small beside the whole; a slow pole
    through which all of the signal goes, as a lag of an amplifier, is none of them.

    Parameters
    ----------
    dynamics
        Stable.
    slow
        Shortest time constant, s.
    most
        How many to take out, the slowest first.
    """
    poles, right = np.linalg.eig(dynamics.A) if dynamics.order else (np.zeros(0), np.zeros((0, 0)))
    is_slow = (np.imag(poles) == 0.0) & (np.real(poles) > np.exp(-dynamics.dt / slow))
    if not is_slow.any():
        return dynamics
    left = np.linalg.inv(right)
    # Partial fractions, at rest.
    share = np.real((dynamics.C @ right) * (left @ dynamics.B) / (1.0 - poles)) / dynamics.dc_gain()
    creeps = np.flatnonzero(is_slow & (np.abs(share) < LARGEST))
    creeps = creeps[np.argsort(-np.real(poles[creeps]))][:most]
    if not creeps.size:
        return dynamics
    rest = np.ones(poles.size, dtype=np.bool_)
    rest[creeps] = False
    project = np.real(right[:, rest] @ left[rest])
    basis = np.linalg.svd(project)[0][:, : int(rest.sum())]
    A = basis.T @ project @ dynamics.A @ basis
    G = LinearDynamics(
        A,
        basis.T @ project @ dynamics.B,
        dynamics.C @ project @ basis,
        dynamics.D,
        dynamics.dt,
        dynamics.delay,
    )
    return of_gain_one(G)


def _weights_of_lags(data: Data, dynamics: LinearDynamics, tau: Array) -> Array:
    """Give weights of lags of the signal behind the hysteresis, over what has not crept of it."""
    data = shortened(data, max(_MOST_SAMPLES // len(data.records), 1))
    banks = [plays_of(each.u, data.half_range) for each in data.records]
    behind = [filtered_by(each, dynamics) for each in banks]
    rows = evenly(data)
    own, target = in_use(data, behind)[rows], data.measured()[rows]
    settling = _settling(data, tau)[rows]
    beside = Basis.of(np.column_stack([own, settling]))
    shape = best_weights(np.column_stack([own, settling]), target)[: own.shape[1] - 1]
    signals = [bank[:, :-1] @ shape for bank in banks]
    lags = answers(data, [each - each[0] for each in signals], tau)
    columns = in_use(data, [filtered_by(each, dynamics) for each in lags])[rows]
    weights, _ = non_negative(beside.out_of(columns), beside.out_of(target))
    return weights


def _settling(data: Data, tau: Array) -> Array:
    """Give what lags still do of their state before each record, shape (samples used, k)."""
    total = []
    for number, record in enumerate(data.records):
        falling = np.exp(-record.dt * np.arange(len(record))[:, None] / tau)
        alone = [
            falling if i == number else np.zeros((len(r), tau.size))
            for i, r in enumerate(data.records)
        ]
        total.append(in_use(data, alone))
    return np.column_stack(total)
