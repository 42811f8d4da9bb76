"""Free constants of a chain of stages, linear dynamics by as few numbers as there are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.identification.fit.free_dynamics import FreeDynamics, has_gain_at_rest
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.scales_between import Link, hidden_scales, neighbours
from hyst.models import LinearDynamics, PrandtlIshlinskii
from hyst.operators import Operator
from hyst.operators.composition import leaves_of
from hyst.operators.parameters import Parameters

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlayBank:
    """Plays of one stage, any of which may move.

    Parameters
    ----------
    stage, constant
        Which stage of the chain, and the place of its first constant.
    weights, radii
        Places in theta, play by play.
    """

    stage: int
    constant: int
    weights: tuple[int, ...]
    radii: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class ChainParametrization(Parametrization):
    """A parametrization that knows which linear dynamics are free as a whole.

    Parameters
    ----------
    single
        Places of the constants that are free one by one: theta begins with them.
    banks
        The plays whose weights and radii are all free.
    dynamics
        The stages that are free as a whole, in the order of the signal.
    sizes_held
        Which of them keep their size, for no record shows it.
    sentences
        What is held, and what stages stand side by side.
    """

    single: tuple[int, ...] = ()
    banks: tuple[PlayBank, ...] = ()
    dynamics: tuple[FreeDynamics, ...] = ()
    sizes_held: tuple[bool, ...] = ()
    sentences: tuple[str, ...] = ()

    @property
    def radii(self) -> tuple[int, ...]:
        """Places in theta of the radii of the plays."""
        return tuple(place for bank in self.banks for place in bank.radii)


@dataclass(frozen=True)
class _Holds:
    """What holds the scales between stages: sizes of stages of dynamics, or single constants."""

    sizes: frozenset[int]
    constants: frozenset[int]
    sentences: tuple[str, ...]


def chain(
    model: Operator, places: Sequence[int], whole: Sequence[int], lower: Array, upper: Array
) -> tuple[ChainParametrization, Array]:
    """Give the free constants of a model and their values.

    Parameters
    ----------
    model
        Any operator.
    places
        Which of its constants may move one by one.
    whole
        Which of its stages are linear dynamics that may move as a whole; of the constants of these,
        only D among ``places`` has a meaning: it may move though it is 0.
    lower, upper
        Shape (constants,), bounds of the constants.

    Returns
    -------
    ChainParametrization
    theta : numpy.ndarray

    Raises
    ------
    InputError
        If dynamics that are free as a whole are not stable, or not moved by their input.
    """
    own = model.parameters()
    links = links_of(model, own, places)
    holds = _holds(links, whole, own)
    taken = {place for i in whole for place in _constants_of(links[i])} | holds.constants
    single = [each for each in places if each not in taken]
    dynamics = _dynamics(links, whole, len(single))
    banks = _banks(links, single, lower, upper)
    fixed = own.values.copy()
    fixed[single] = 0.0
    count = len(single) + sum(each.size for each in dynamics)
    transform = np.zeros((len(own), count))
    transform[single, range(len(single))] = 1.0
    for each in dynamics:
        fixed[each.constants] = each.fixed()
        transform[each.constants, each.own] = each.transform()
    endless = np.full(count - len(single), np.inf)
    sizes_held = tuple(i in holds.sizes for i in whole)
    held = [each for each, is_held in zip(dynamics, sizes_held, strict=True) if is_held]
    parametrization = ChainParametrization(
        model,
        transform,
        fixed,
        np.concatenate([lower[single], -endless]),
        np.concatenate([upper[single], endless]),
        canonical=_canonical(model, fixed, transform, single, (lower, upper), banks),
        gauges=_gauges(held),
        gauge_count=len(held),
        is_allowed=_is_allowed(model, fixed, transform, dynamics),
        single=tuple(single),
        banks=banks,
        dynamics=dynamics,
        sizes_held=sizes_held,
        sentences=holds.sentences,
    )
    start = [own.values[single], *(each.start() for each in dynamics)]
    return parametrization, np.concatenate(start)


def links_of(model: Operator, own: Parameters, places: Sequence[int]) -> tuple[Link, ...]:
    """Take a model apart into its stages.

    Parameters
    ----------
    model
        Any operator.
    own
        Its constants.
    places
        Which of them may move.
    """
    free = np.zeros(len(own), dtype=bool)
    free[list(places)] = True
    links, at, leaves = list[Link](), 0, leaves_of(model)
    for leaf in leaves:
        count = len(leaf.parameters())
        name = own.names[at].split(".")[0] if len(leaves) > 1 and count else ""
        links.append(Link(name, leaf, at, free[at : at + count]))
        at += count
    return tuple(links)


def _constants_of(link: Link) -> range:
    return range(link.constant, link.constant + link.free.size)


def _dynamics(links: Sequence[Link], whole: Sequence[int], first: int) -> tuple[FreeDynamics, ...]:
    made = list[FreeDynamics]()
    for i in whole:
        stage = links[i].stage
        assert isinstance(stage, LinearDynamics), "only these are free as a whole"
        feedthrough = bool(links[i].free[-1]) or stage.D != 0.0
        each = FreeDynamics.of(links[i].name, stage, links[i].constant, first, feedthrough)
        made.append(each)
        first += each.size
    return tuple(made)


def _banks(
    links: Sequence[Link], single: Sequence[int], lower: Array, upper: Array
) -> tuple[PlayBank, ...]:
    """Find plays that are all free within the same bounds, so that their order means nothing."""
    theta, banks = {place: at for at, place in enumerate(single)}, list[PlayBank]()
    for i, each in enumerate(links):
        if not isinstance(each.stage, PrandtlIshlinskii) or each.stage.z0.any():
            continue
        n = each.stage.p.size
        weights, radii = (
            list(range(first, first + n)) for first in (each.constant + 1, each.constant + 1 + n)
        )
        alike = (
            all(
                (ends[of] == ends[of[0]]).all()
                for of in (weights, radii)
                for ends in (lower, upper)
            )
            if n
            else False
        )
        if n and alike and theta.keys() >= {*weights, *radii}:
            of_theta = (tuple(theta[place] for place in places) for places in (weights, radii))
            banks.append(PlayBank(i, each.constant, *of_theta))
    return tuple(banks)


def _sorted(theta: Array, banks: Sequence[PlayBank]) -> Array:
    """Give plays in the order of their radii, each with its weight."""
    for bank in banks:
        weights, radii = list(bank.weights), list(bank.radii)
        order = np.argsort(theta[radii], kind="stable")
        if (order[1:] < order[:-1]).any():
            theta = theta.copy()
            theta[weights], theta[radii] = theta[weights][order], theta[radii][order]
    return theta


def _holds(links: Sequence[Link], whole: Sequence[int], own: Parameters) -> _Holds:
    """Hold one side of every scale between stages: dynamics once each, else a constant."""
    sizes, constants, sentences = set[int](), set[int](), list[str]()
    for one, other in hidden_scales(links, whole):
        open_ones = [each for each in (one, other) if each in whole and each not in sizes]
        if open_ones:
            at = open_ones[0]
            sizes.add(at)
            what = _size_held(links[at])
        else:
            moved = {
                each: _moved(links[each], ends)
                for each, ends in ((one, (1.0, 2.0)), (other, (2.0, 1.0)))
                if each not in whole
            }
            at = min(moved, key=lambda each: moved[each].size)
            constant = int(moved[at][0])
            constants.add(constant)
            what = f"{own.names[constant]} is held at {own.values[constant]:.6g}"
        beside = links[other if at == one else one].name
        sentences.append(
            f"{what}: records show only its product with the scale of {beside}, whose constants "
            "hold for it"
        )
    for one, other in neighbours(links, whole):
        sentences.append(
            f"{links[one].name} and {links[other].name} follow each other with nothing but linear "
            "stages between them: records show their product only, and which poles and zeros are "
            "of which is as it was in the start"
        )
    return _Holds(frozenset(sizes), frozenset(constants), tuple(sentences))


def _moved(link: Link, ends: tuple[float, float]) -> NDArray[np.intp]:
    """Give the places of the constants of a stage that take a scale."""
    moved = link.moved(*ends)
    assert moved is not None, "it takes the scale"
    return link.constant + np.flatnonzero(moved)


def _size_held(link: Link) -> str:
    stage = link.stage
    assert isinstance(stage, LinearDynamics), "it is free as a whole"
    if has_gain_at_rest(stage):
        return f"the gain of {link.name} at rest is held at {stage.dc_gain():.6g}"
    return f"the size of {link.name}, which has no gain at rest, is held as it was in the start"


def _canonical(
    model: Operator,
    fixed: Array,
    transform: Array,
    single: Sequence[int],
    bounds: tuple[Array, Array],
    banks: Sequence[PlayBank],
) -> Callable[[Array], Array]:
    places, count = list(single), len(single)
    lower, upper = bounds[0][places], bounds[1][places]

    def canonical(theta: Array) -> Array:
        theta = _sorted(theta, banks)
        nearest = model.nearest_parameters(fixed + transform @ theta)[places]
        return np.concatenate([np.clip(nearest, lower, upper), theta[count:]])

    return canonical


def _is_allowed(
    model: Operator, fixed: Array, transform: Array, dynamics: Sequence[FreeDynamics]
) -> Callable[[Array], bool]:
    """Keep stable what is free as a whole."""

    def is_allowed(theta: Array) -> bool:
        try:
            model.with_parameters(fixed + transform @ theta)
        except InputError:
            return False
        return all(each.is_stable(theta) for each in dynamics)

    return is_allowed


def _gauges(held: Sequence[FreeDynamics]) -> Callable[[Array], tuple[Array, Array]] | None:
    if not held:
        return None

    def gauges(theta: Array) -> tuple[Array, Array]:
        pairs = [each.gauge(theta) for each in held]
        return np.array([value for value, _ in pairs]), np.array([row for _, row in pairs])

    return gauges
