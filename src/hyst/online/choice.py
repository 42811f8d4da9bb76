"""Which estimator follows a model: the one place where its family or kind decides."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from hyst.errors import InputError
from hyst.online.checks import names_of
from hyst.online.estimator import Estimator
from hyst.online.joint.joint_core import GROUPS
from hyst.online.joint.joint_estimator import JointEstimator
from hyst.online.joint.parts import take_apart
from hyst.online.model.model_estimator import ModelEstimator
from hyst.online.scale.scale_estimator import ScaleEstimator
from hyst.operators import Operator

ESTIMATORS = ("scale", "joint", "model")
"""Names of the estimators, the cheapest first."""

_SCALE = ("scale", "offset")


def estimator_for(
    model: Operator,
    *,
    dt: float | None = None,
    memory: float = math.inf,
    spread: float | None = None,
    only: Iterable[str] = (),
    estimator: str = "auto",
    **options: Any,
) -> Estimator:
    """Make the estimator that suits a model and what is to be estimated.

    Scale and offset are estimated of any model, the joint estimator has all constants of plays and
    maps, the one of the model's own constants those of any family.

    Parameters
    ----------
    model
        Where to start.
    dt
        Sample time, seconds; the model's own or 1 if left out.
    memory
        Seconds over which the past is forgotten.
    spread
        How far off the start is believed to be, a share; each estimator's own if left out.
    only
        What to estimate, by name, everything else being held: ``"scale"`` and ``"offset"``, or
        parameters and groups of another estimator. Everything if left out.
    estimator
        One of ``ESTIMATORS``, or ``"auto"``: the one that has what ``only`` names; without, the
        joint one for plays and maps, else the cheap one of scale and offset.
    options
        More options of that estimator.

    Returns
    -------
    Estimator

    Raises
    ------
    InputError
        If the estimator cannot follow the model, or a name is unknown.
    NotInvertibleError
        If one of all constants cannot start from the model, which has no inverse.

    Examples
    --------
    >>> import hyst
    >>> plays = hyst.PrandtlIshlinskii([0.5], [1.0], 1.0)
    >>> estimator_for(plays).names, estimator_for(plays, only="scale").settings["held"]
    (('p0', 'p[1]', 'r[1]', 'offset'), ['offset'])
    >>> estimator_for(hyst.models.BoucWen(0.6, 0.35, 0.12, 0.06)).names
    ('scale', 'offset')
    """
    wanted = [only] if isinstance(only, str) else list(only)
    name = name_of_estimator(model, wanted) if estimator == "auto" else estimator
    if name not in ESTIMATORS:
        known = ", ".join(("auto", *ESTIMATORS))
        raise InputError(f"there is no estimator {name!r}; choose one of {known}")
    if spread is not None:
        options |= _spreads(name, spread)
    if name == "scale":
        held = [] if not wanted else _others(wanted, _SCALE, _SCALE)
        return ScaleEstimator(model, dt=dt, memory=memory, held=held, **options)
    if name == "model":
        held = _held_of_model(model, wanted)
        return ModelEstimator(model, dt=dt, memory=memory, held=held, **options)
    held = _held_jointly(model, wanted)
    if any(each.startswith(("front", "back")) for each in wanted):
        options.setdefault("estimate_maps", True)
    steps = (1.0 if model.dt is None else model.dt) if dt is None else dt
    return JointEstimator(model, dt=steps, memory=memory, held=held, **options)


def name_of_estimator(model: Operator, only: Iterable[str] = ()) -> str:
    """Give the name of the estimator that has what is to be estimated.

    Parameters
    ----------
    model
        Where to start.
    only
        Names of what to estimate; everything if left out.

    Returns
    -------
    str
        One of ``ESTIMATORS``.

    Raises
    ------
    InputError
        If the model is no operator.

    Examples
    --------
    >>> import hyst
    >>> name_of_estimator(hyst.RambergOsgood(1.0, 0.5, 1.2))
    'scale'
    >>> name_of_estimator(hyst.RambergOsgood(1.0, 0.5, 1.2), ["c1", "c2"])
    'model'
    """
    if not isinstance(model, Operator):
        raise InputError(f"model is a {type(model).__name__}; give an operator")
    wanted = [only] if isinstance(only, str) else list(only)
    if "scale" in wanted or wanted == ["offset"]:
        return "scale"
    try:
        of_plays = take_apart(model).names()
    except InputError:
        of_plays = ()
    if of_plays and all(each in (*of_plays, *GROUPS) for each in wanted):
        return "joint"
    own = _with_groups(model.parameters().names)
    if wanted and all(each in own for each in wanted):
        return "model"
    return "joint" if of_plays else "scale"


def _with_groups(names: tuple[str, ...]) -> tuple[str, ...]:
    """Give names, and those of the groups they are of: ``p`` of ``p[1]``."""
    return (*names, *dict.fromkeys(each.partition("[")[0] for each in names if "[" in each))


def _held_of_model(model: Operator, wanted: list[str]) -> list[str]:
    names = tuple(model.parameters().names)
    return _others(wanted, names, _with_groups(names)) if wanted else []


def _spreads(name: str, spread: float) -> dict[str, float]:
    if name == "joint":
        return {"radius_spread": spread, "weight_spread": spread}
    return {"spread": spread}


def _held_jointly(model: Operator, wanted: list[str]) -> list[str]:
    names = take_apart(model).names()
    return _others(wanted, names, (*names, *GROUPS)) if wanted else []


def _others(wanted: list[str], names: tuple[str, ...], known: tuple[str, ...]) -> list[str]:
    """Give the names that are neither wanted nor of a wanted group."""
    chosen = names_of(wanted, known, "only")
    return [each for each in names if each not in chosen and each.partition("[")[0] not in chosen]
