"""Simulated actuators of many kinds, most of them in no model's class, to judge a choice by.

Inputs lie between -1 and 1. Every kind is written down from its own equations and shares nothing
with the models of hyst; the banks of plays are the models' own case.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SWITCHING, FRICTION, PLAYS = "switching", "friction", "plays"
STEPS = 40
"""Of the differential equations, from sample to sample."""


@dataclass(frozen=True)
class Plant:
    """A simulated actuator.

    Parameters
    ----------
    name
        For tables.
    kind
        ``switching``, ``friction`` or ``plays``.
    output
        Gives the output for an input between -1 and 1, from rest.
    """

    name: str
    kind: str
    output: Callable[[Array], Array]


def triangle(turns: Sequence[float], samples: int) -> Array:
    """Give straight strokes from turn to turn."""
    strokes = [np.linspace(a, b, samples, endpoint=False) for a, b in itertools.pairwise(turns)]
    return np.concatenate([*strokes, [turns[-1]]])


def major_loops(samples: int = 60) -> Array:
    """Give three and a half loops over the whole range."""
    return triangle([0.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0], samples)


def shrinking_loops(samples: int = 40) -> Array:
    """Give loops of shrinking amplitude, as a record that shows minor loops has them."""
    turns = [0.0]
    for size in (1.0, 1.0, 0.85, 0.7, 0.55, 0.4, 0.25, 0.12):
        turns += [size, -size]
    return triangle(turns, samples)


def nested_loops(samples: int = 30) -> Array:
    """Give a whole loop, and minor loops within one another at several levels after it."""
    turns = [0.0, 1, -1, 1, 0.3, 0.8, -0.2, 0.5, -0.5, 0.2, -0.9, -0.4, -0.7, 0.4, -1, 0.1, -0.3]
    return triangle([*turns, 0.6], samples)


def preisach(name: str, density: Callable[[Array, Array], Array], slope: float = 0.0) -> Plant:
    """Give a non-negative Preisach model, and a line beside it.

    Parameters
    ----------
    name
        For tables.
    density
        Of relays over their mean and half their width.
    slope
        Of the line, with a saturation of 1 on either side.
    """
    cells = 80
    edge = -1.0 + 2.0 / cells * (np.arange(cells) + 0.5)
    up, down = np.meshgrid(edge, edge, indexing="ij")
    weights = density((up + down) / 2.0, (up - down) / 2.0) * (up >= down)
    weights /= weights.sum()

    def output(u: Array) -> Array:
        state, y = -np.ones((cells, cells)), []
        for sample in u:
            state[edge <= sample, :] = 1.0
            state[:, edge > sample] = -1.0
            y.append(float((weights * state).sum()))
        return np.array(y) + slope * u

    return Plant(name, SWITCHING, output)


def bell(x: Array, width: float) -> Array:
    """Give a normal density."""
    return np.asarray(np.exp(-0.5 * (x / width) ** 2))


def rate_of(name: str, kind: str, slope: Callable[..., float], linear: float) -> Plant:
    """Give ``y = linear u + z`` with ``dz/du = slope(u, z, direction)``."""

    def output(u: Array) -> Array:
        z, before, y = 0.0, 0.0, []
        for sample in u.tolist():
            step = (sample - before) / STEPS
            direction = 1.0 if step > 0.0 else -1.0
            for k in range(STEPS):
                middle = before + (k + 0.5) * step
                half = z + 0.5 * step * slope(middle - 0.5 * step, z, direction)
                z += step * slope(middle, half, direction)
            before = sample
            y.append(linear * sample + z)
        return np.array(y)

    return Plant(name, kind, output)


def bouc_wen(alpha: float, beta: float, gamma: float, n: float, linear: float) -> Plant:
    """Give ``dz = alpha du - beta |du| |z|^(n-1) z - gamma du |z|^n``."""

    def slope(u: float, z: float, direction: float) -> float:
        size = abs(z)
        return alpha - beta * direction * size ** (n - 1.0) * z - gamma * size**n

    name = f"Bouc-Wen {alpha:g} {beta:g} {gamma:g} n {n:g}, line {linear:g}"
    return rate_of(name, FRICTION, slope, linear)


def dahl(sigma: float, force: float, n: float, linear: float) -> Plant:
    """Give Dahl's ``dz = sigma (1 - direction z / force)^n du``."""

    def slope(u: float, z: float, direction: float) -> float:
        left = 1.0 - direction * z / force
        return sigma * float(np.sign(left)) * abs(left) ** n

    return rate_of(f"Dahl {sigma:g}/{force:g} n {n:g}, line {linear:g}", FRICTION, slope, linear)


def coleman_hodgdon(alpha: float, a: float, b: float, bend: float) -> Plant:
    """Give ``dy = alpha |du| (f(u) - y) + g du`` with f linear and then bent."""

    def slope(u: float, z: float, direction: float) -> float:
        return alpha * direction * (a * float(np.tanh(u / bend)) * bend - z) + b

    return rate_of(f"Coleman-Hodgdon {alpha:g} {a:g} {b:g} {bend:g}", PLAYS, slope, 0.0)


def jiles_atherton(shape: float, pinning: float, reversible: float, coupling: float) -> Plant:
    """Give ``dM/dH`` of Jiles and Atherton, the irreversible part only towards the anhysteretic."""

    def slope(u: float, z: float, direction: float) -> float:
        x = (u + coupling * z) / shape
        rest = float(np.tanh(x))
        bent = (1.0 - rest**2) / shape
        towards = max((rest - z) * direction, 0.0)
        moved = towards / max(pinning - coupling * towards, 0.05)
        return (1.0 - reversible) * moved + reversible * bent

    name = f"Jiles-Atherton {shape:g} {pinning:g} {reversible:g} {coupling:g}"
    return rate_of(name, SWITCHING, slope, 0.0)


def bank(
    name: str,
    kind: str,
    loading: Callable[[Array], Array],
    before: Callable[[Array], Array] | None = None,
    after: Callable[[Array], Array] | None = None,
) -> Plant:
    """Give Masing loops of a loading curve, as a bank of 200 plays, and maps beside it.

    Parameters
    ----------
    name, kind
        As of ``Plant``.
    loading
        Output over the input from rest; convex where loops turn flat after a reversal.
    before, after
        Maps of the input and of the output.
    """
    grid = np.linspace(0.0, 1.0, 201)
    slopes = np.diff(loading(grid)) / np.diff(grid)
    radii, weights = grid[1:-1], np.diff(slopes)

    def output(u: Array) -> Array:
        v = u if before is None else before(u)
        z, y = np.zeros(radii.size), []
        for sample in v.tolist():
            z = np.maximum(sample - radii, np.minimum(sample + radii, z))
            y.append(slopes[0] * sample + float(weights @ z))
        return np.array(y) if after is None else after(np.array(y))

    return Plant(name, kind, output)


def relays(seed: int, count: int, slope: float) -> Plant:
    """Give a few relays, whose steps can be seen, and a line."""
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-0.5, 0.5, count), rng.uniform(0.1, 0.4, count)
    weights = rng.uniform(0.5, 1.0, count) / count

    def output(u: Array) -> Array:
        state, y = -np.ones(count), []
        for sample in u:
            state[sample >= middle + half] = 1.0
            state[sample < middle - half] = -1.0
            y.append(float(weights @ state) + slope * float(sample))
        return np.array(y)

    return Plant(f"{count} relays, line {slope:g}", SWITCHING, output)


def plants() -> tuple[Plant, ...]:
    """Give all of them."""
    return (*switching(), *friction(), *plays())


def switching() -> tuple[Plant, ...]:
    """Give materials whose parts switch between two states."""

    def smooth(mean: float, centre: float, width: float) -> Callable[[Array, Array], Array]:
        return lambda bias, half: bell(bias, mean) * bell(half - centre, width)

    return (
        preisach("Preisach, smooth", smooth(0.3, 0.25, 0.15)),
        preisach("Preisach, narrow", smooth(0.2, 0.35, 0.1)),
        preisach("Preisach, wide", smooth(0.5, 0.1, 0.2)),
        preisach("Preisach, square", smooth(0.12, 0.45, 0.06)),
        preisach("Preisach, with a line", smooth(0.3, 0.3, 0.15), 0.5),
        preisach(
            "Preisach, correlated",
            lambda b, h: bell(b - 0.5 * (h - 0.3), 0.2) * bell(h - 0.3, 0.15),
        ),
        preisach(
            "Preisach, wider outside", lambda b, h: bell(b, 0.4) * bell(h - 0.15 - 0.4 * b**2, 0.1)
        ),
        preisach("Preisach, biased", lambda b, h: bell(b - 0.2, 0.25) * bell(h - 0.3, 0.12)),
        preisach(
            "Preisach, Cauchy",
            lambda b, h: 1.0 / (1 + (b / 0.2) ** 2) / (1 + ((h - 0.25) / 0.1) ** 2),
        ),
        preisach("Preisach, even", lambda b, h: np.ones_like(b)),
        preisach(
            "Preisach, two materials",
            lambda b, h: bell(b, 0.2) * (bell(h - 0.15, 0.06) + 0.7 * bell(h - 0.5, 0.08)),
        ),
        relays(1, 12, 0.5),
        relays(2, 40, 0.2),
        jiles_atherton(0.2, 0.3, 0.2, 0.1),
        jiles_atherton(0.35, 0.2, 0.1, 0.0),
        jiles_atherton(0.15, 0.5, 0.3, 0.1),
    )


def friction() -> tuple[Plant, ...]:
    """Give what is stiff after a reversal and softens."""

    def power(exponent: float) -> Callable[[Array], Array]:
        return lambda x: np.asarray(x**exponent)

    return (
        bouc_wen(1.0, 1.5, 0.8, 1.2, 0.3),
        bouc_wen(1.0, 3.0, -0.5, 1.0, 0.1),
        bouc_wen(0.5, 1.0, 0.9, 2.0, 1.0),
        bouc_wen(1.0, 0.9, -0.6, 1.0, 0.5),
        bouc_wen(-0.35, 1.2, 0.6, 1.0, 0.6),
        dahl(8.0, 1.0, 1.0, 0.5),
        dahl(3.0, 0.5, 1.0, 1.0),
        dahl(5.0, 1.0, 1.6, 0.3),
        bank("Masing, power 0.5", FRICTION, power(0.5)),
        bank("Masing, power 0.8", FRICTION, power(0.8)),
        bank("elastic-plastic", FRICTION, lambda x: np.minimum(x, 0.3) + 0.2 * x),
        bank("softening, bent", FRICTION, lambda x: np.tanh(2 * x), after=lambda y: y + 0.2 * y**2),
        bank("softening, hardening", FRICTION, lambda x: np.tanh(3 * x) + 0.7 * x**3),
    )


def plays() -> tuple[Plant, ...]:
    """Give what starts slowly after a reversal, as a piezo does, with and without maps."""

    def soon(x: Array) -> Array:
        return np.asarray(0.6 * x + 0.4 * x**2)

    def late(x: Array) -> Array:
        return np.asarray(0.8 * x + 0.4 * np.maximum(x - 0.5, 0.0))

    return (
        bank("plays", PLAYS, soon),
        bank("plays, few", PLAYS, late),
        bank("plays, power 1.5", PLAYS, lambda x: np.asarray(x**1.5)),
        bank("plays and an odd map", PLAYS, soon, after=lambda y: y - 0.25 * y**3),
        bank("plays and an even map", PLAYS, soon, after=lambda y: y + 0.25 * y**2),
        bank("plays and a saturation", PLAYS, soon, after=lambda y: np.tanh(2.0 * y)),
        bank("odd envelope and plays", PLAYS, soon, before=lambda u: (u + 0.5 * u**3) / 1.5),
        bank("saturating envelope", PLAYS, soon, before=lambda u: np.tanh(2 * u) / np.tanh(2)),
        bank("even envelope and plays", PLAYS, soon, before=lambda u: (u + 0.3 * u**2) / 1.3),
        coleman_hodgdon(1.0, 1.2, 0.4, 5.0),
        coleman_hodgdon(2.0, 1.0, 0.2, 0.5),
        coleman_hodgdon(0.5, 1.5, 1.0, 1.0),
    )
