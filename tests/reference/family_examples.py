"""An actuator of every family, and how it is driven: a new family is one entry here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

import hyst
from hyst import Record
from hyst.operators import Affine, Operator
from reference.foreign_records import switching

DT = 1e-3


@dataclass(frozen=True, eq=False)
class FamilyExample:
    """An actuator of a family.

    Parameters
    ----------
    model
        The true operator.
    drives
        Inputs that show all its constants, one a record.
    options
        Of the family: what the actuator is known to be.
    noise
        Standard deviation of the noise that scatter is judged with, over the output's range.
    exactly
        Relative error to which the constants come back without noise.
    unit_of_its_own
        How the names of constants end whose unit depends on another constant; nothing by default.
    told
        What the family tells beside constants of its model, with its true value.
    told_units
        Powers of the input's and the output's unit in it; what is not named has no unit.
        What the family tells beside constants of its model, which has no unit, with its true value.
    foreign
        What another actuator makes of a drive, of which the family must know that it is none of it.
    """

    model: Operator
    drives: tuple[np.ndarray, ...]
    options: dict[str, Any] = field(default_factory=dict)
    noise: float = 0.005
    exactly: float = 1e-6
    unit_of_its_own: str = "?"
    told: dict[str, float] = field(default_factory=dict)
    told_units: dict[str, tuple[int, int]] = field(default_factory=dict)
    foreign: Callable[[np.ndarray], np.ndarray] = lambda u: switching(u) ** 2  # a butterfly

    def records(self, noise: float = 0.0, seed: int = 0) -> list[Record]:
        """Give the records of the actuator with noise of a share of the output's range."""
        rng = np.random.default_rng(seed)
        records = []
        for u in self.drives:
            y = self.model(u)
            records.append(Record(u, y + noise * np.ptp(y) * rng.normal(size=u.size), DT))
        return records


def decaying(samples: int = 1500, turns: float = 6.25) -> np.ndarray:
    """Give a sine that decays from 1 after two full strokes."""
    t = np.arange(samples) / samples
    size = np.where(t < 0.3, 1.0, np.exp(-1.5 * (t - 0.3)))
    return size * np.sin(2.0 * np.pi * turns * t)


def sine(frequency: float, samples: int) -> np.ndarray:
    """Give a sine of amplitude 1."""
    return np.sin(2.0 * np.pi * frequency * np.arange(samples) * DT)


def _plays(p0: float = 1.0) -> hyst.PrandtlIshlinskii:
    return hyst.PrandtlIshlinskii([0.5, 0.3], [0.12, 0.41], p0)


def _map(knots: list[float]) -> hyst.DeadZone:
    return hyst.DeadZone([1.0, 0.2, -0.15], [0.0, *knots])


def _two_envelopes(u: np.ndarray) -> hyst.TwoEnvelopePrandtlIshlinskii:
    """Slopes 0.7, 1, 0.6 up and 1.2, 0.8, 0.9 down, between thirds of the input."""
    low, high = _thirds(u)
    ends = [float(u.min()), low, high, float(u.max())]
    rising = hyst.DeadZone([1.0, -0.3, -0.4], [0.0, low, high])
    falling = hyst.DeadZone([0.8, -0.5, 0.4, 0.1, -0.3], [0.0, *ends])
    return hyst.TwoEnvelopePrandtlIshlinskii([0.5, 0.3], [0.2, 0.45], rising, falling, 1.0)


def _rate_dependent() -> Operator:
    plays = hyst.RateDependentPrandtlIshlinskii([0.5, 0.3], [0.15, 0.3], 4e-3, DT, p0=1.0)
    return Affine(1.0, 0.3) @ plays


def _relays(u: np.ndarray, levels: int = 6) -> hyst.Preisach:
    """A density that falls away from a middle, constant in the cells that the family takes."""
    edges = u.min() + np.ptp(u) * np.arange(levels + 1) / levels
    beta, alpha = np.meshgrid((edges[1:] + edges[:-1]) / 2.0, (edges[1:] + edges[:-1]) / 2.0)
    density = np.exp(-(((alpha - beta) / 2.0 - 0.4) ** 2) - ((alpha + beta) / 2.0) ** 2 / 2.0)
    weights = np.tril(density * (1.0 - 0.5 * np.eye(levels)))
    return hyst.Preisach(weights / weights.sum(), edges, 0.2)


def _means(relays: hyst.Preisach) -> dict[str, float]:
    """Mass and mean thresholds of relays; of a triangle a third of its side lies between them."""
    low, side = relays.thresholds[:-1], np.diff(relays.thresholds)
    alpha = low[:, None] + np.where(np.eye(side.size) > 0.0, 2.0 / 3.0, 0.5) * side[:, None]
    beta = low + np.where(np.eye(side.size) > 0.0, 1.0 / 3.0, 0.5) * side
    mass = relays.weights.sum()
    return {
        "preisach.switched": 2.0 * mass,
        "preisach.coercive": float((relays.weights * (alpha - beta)).sum() / (2.0 * mass)),
        "preisach.bias": float((relays.weights * (alpha + beta)).sum() / (2.0 * mass)),
    }


RELAY_UNITS = {"preisach.switched": (0, 1), "preisach.coercive": (1, 0), "preisach.bias": (1, 0)}


def _preisach() -> FamilyExample:
    relays = _relays(decaying())
    return FamilyExample(
        Affine(1.0, 0.3) @ relays,
        (decaying(),),
        {"levels": 6},
        told=_means(relays),
        told_units=RELAY_UNITS,
    )


def resting(turns: list[float], samples: int) -> np.ndarray:
    """Give straight strokes of so many samples a unit, each followed by three samples of rest."""
    parts = [np.full(3, turns[0])]
    for start, end in pairwise(turns):
        steps = round(samples * abs(end - start))
        parts.append(start + (end - start) * np.arange(1, steps + 1) / steps)
        parts.append(np.full(3, end))
    return np.concatenate(parts)


def _rate_dependent_relays() -> FamilyExample:
    """Rests at the ends show the relays the whole range, whatever their shift: the same cells."""
    turns = [0.0, 1.0, -1.0, 0.6, -0.5, 0.3, -1.0, 1.0, -0.3, 0.4, -0.7, 1.0, 0.1, 0.8, -1.0]
    drives = tuple(resting(turns, samples) for samples in (80, 20, 6))
    relays = _relays(np.array([-1.0, 1.0]), levels=5)
    return FamilyExample(
        Affine(1.0, 0.3) @ relays @ hyst.RateShift(0.02, 0.4, DT),
        drives,
        {"levels": 5, "smoothness": 0},
        unit_of_its_own=".c",  # the input's unit to the power 1 - m is in it
        told=_means(relays),
        told_units=RELAY_UNITS,
    )


def _hammerstein() -> FamilyExample:
    """Plays before a resonance, ``(0.2 q^-1 + 0.1 q^-2) / (1 + a1 q^-1 + a2 q^-2)``: gain 1."""
    a1, a2 = -1.4, 0.7
    dynamics = hyst.LinearDynamics.from_transfer_function([0.2, 0.1], [1.0, a1, a2], DT)
    told = {"a[1]": a1, "a[2]": a2, "b[0]": 0.0, "b[1]": 0.2, "b[2]": 0.1}
    return FamilyExample(
        dynamics @ (Affine(1.0, 0.3) @ _plays()),
        (hyst.signals.multisine(DT, 3000, amplitude=1.0).u,),
        {"hysteresis": "pi", "plays": 2, "state_order": 2},
        told={f"dynamics.{name}": value for name, value in told.items()},
    )


def _butterfly() -> FamilyExample:
    """Strain of a material that switches, and a loop that only rises, which is none."""
    drive = decaying()
    low, high = float(drive.min()), float(drive.max())
    ends = np.linspace(low, high, 6)
    slopes = np.array([0.3, 1.6, 0.5, 1.9, 0.4])
    slopes *= (high - low) / float(slopes @ np.diff(ends))  # the envelope rises by the range
    a, b, c, d, e = slopes
    envelope = hyst.DeadZone([c, a - b, b - c, d - c, e - d], [0.0, *ends[1:5]])
    r = np.array([0.3, 0.6])
    p = np.array([0.6, 0.4])
    p /= float(p @ (0.5 * (high - low) - r))  # the state goes from -1 to 1
    plays = hyst.PrandtlIshlinskii(p, r)
    strain = [[0.3, 0.05, 1.0], [0.1, 0.4, 0.0], [0.15, 0.0, 0.0]]
    return FamilyExample(
        hyst.Butterfly(hyst.GeneralizedPrandtlIshlinskii(envelope, plays), strain),
        (drive,),
        {"plays": 2, "knots": 4},
        foreign=switching,
    )


_MAKE: dict[str, Callable[[], FamilyExample]] = {
    "linear": lambda: FamilyExample(Affine(-1.3, 0.4), (decaying(),)),
    "butterfly": _butterfly,
    "dahl": lambda: FamilyExample(Affine(-1.0, 0.3) @ hyst.Dahl(4.0, 1.5), (decaying(),)),
    "bouc-wen": lambda: FamilyExample(
        Affine(-1.0, 0.3) @ hyst.BoucWen(1.2, 0.6, 1.4, 0.5, h=-1.0), (decaying(),)
    ),
    "lugre": lambda: FamilyExample(
        Affine(-1.0, 0.3) @ hyst.LuGre(30.0, 0.02, 0.03, 1.0, 1.6, 5.0, DT),
        (decaying(),),
        {"stribeck": "free", "viscosity": "linear"},
    ),
    "maxwell-slip": lambda: FamilyExample(
        Affine(-1.0, 0.3) @ hyst.MaxwellSlip([3.0, 1.0], [0.36, 0.41], 0.5),
        (decaying(),),
        {"plays": 2},
    ),
    "coleman-hodgdon": lambda: FamilyExample(
        Affine(1.0, 0.3) @ hyst.ColemanHodgdon(2.0, 1.5, 1.1), (decaying(),)
    ),
    "jiles-atherton": lambda: FamilyExample(
        Affine(-1.0, 0.3) @ hyst.JilesAtherton(2.0, 0.25, 0.2, 0.3, 0.15), (decaying(600),)
    ),
    "ramberg-osgood": lambda: FamilyExample(
        Affine(1.0, 0.3) @ hyst.RambergOsgood(1.0, 0.6, 0.8),
        (decaying(),),
        unit_of_its_own=".c2",  # the input's unit to the power c3 is in it
    ),
    "masing": lambda: FamilyExample(
        Affine(1.0, 0.3) @ hyst.MasingOperator(hyst.models.ExponentialCurve(1.5, 1.0, 0.4)),
        (decaying(),),
    ),
    "iwan": lambda: FamilyExample(
        Affine(-1.0, 0.3) @ hyst.Iwan(1.0, 3.0, -0.3, 0.5, 0.4), (decaying(),)
    ),
    "pi": lambda: FamilyExample(Affine(-1.0, 0.3) @ _plays(), (decaying(),), {"plays": 2}),
    # Knots where the family puts them: evenly over the signal the map acts on.
    "gpi": lambda: FamilyExample(
        Affine(1.0, 0.3) @ hyst.GeneralizedPrandtlIshlinskii(_map(_thirds(decaying())), _plays()),
        (decaying(),),
        {"plays": 2, "knots": 2},
    ),
    # Where the knots of an output map lie follows from the noise; on a straight one they may be
    # anywhere, and its slopes must come out as 1.
    "mpi": lambda: FamilyExample(
        Affine(1.0, 0.3) @ _plays(), (decaying(),), {"plays": 2, "knots": 2}
    ),
    # Knots where the family puts them, and at the ends of the input, beyond which both go on alike.
    "two-envelope": lambda: FamilyExample(
        Affine(1.0, 0.3) @ _two_envelopes(decaying()), (decaying(),), {"plays": 2, "knots": 2}
    ),
    "rdpi": lambda: FamilyExample(
        _rate_dependent(), (sine(1.0, 1700), sine(20.0, 300), sine(60.0, 300)), {"plays": 2}
    ),
    "preisach": _preisach,
    "rate-dependent-preisach": _rate_dependent_relays,
    "hammerstein": _hammerstein,
}


def _thirds(signal: np.ndarray) -> list[float]:
    return list(np.linspace(signal.min(), signal.max(), 4)[1:-1])


def family_example(name: str) -> FamilyExample:
    """Give the actuator of a family."""
    return _MAKE[name]()


def names_with_an_example() -> set[str]:
    """Give the families that have one."""
    return set(_MAKE)
