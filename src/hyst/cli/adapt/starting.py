"""The estimator: made for a model, or as an earlier run has left it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import hyst
from hyst.checks.numbers import as_positive
from hyst.cli.arguments import load_operator

_SPREAD = 0.3


@final
@dataclass(frozen=True)
class Asked:
    """What was typed about the estimator and its guard; what was not is None or empty.

    Parameters
    ----------
    memory, spread
        Seconds, and a share.
    only
        Names with commas between them.
    which
        Name of the estimator, or ``auto``.
    estimate_maps
        Whether the maps are estimated.
    guard
        Whether there is to be a guard.
    window
        Of the guard: seconds or ``auto``.
    """

    memory: float | None
    spread: float | None
    only: str
    which: str
    estimate_maps: bool
    guard: bool
    window: str

    @property
    def of_all_constants(self) -> Mapping[str, bool]:
        """What only estimators of more than radii are asked, and whether it was."""
        return {name: typed for name, typed in self.of_a_start.items() if name != "--memory"}

    @property
    def of_a_start(self) -> Mapping[str, bool]:
        """What a start alone is asked, and whether it was."""
        return {
            "--memory": self.memory is not None,
            "--spread": self.spread is not None,
            "--only": bool(self.only),
            "--estimator": self.which != "auto",
            "--estimate-maps": self.estimate_maps,
        }


@final
@dataclass(frozen=True)
class Found:
    """What an earlier run has left.

    Parameters
    ----------
    estimator
        It goes on.
    inverse
        With its guard, if it had one.
    model
        What says what its numbers mean.
    """

    estimator: hyst.online.Estimator
    inverse: hyst.online.AdaptiveInverse | None
    model: hyst.operators.Operator


def started(model: hyst.operators.Operator, dt: float, asked: Asked) -> hyst.online.Estimator:
    """Make the estimator that knows nothing but the model yet.

    Parameters
    ----------
    model
        Where it starts.
    dt
        Sample time of the record, seconds.
    asked
        What was typed.

    Raises
    ------
    InputError
        If no estimator can follow the model as asked.
    """
    options: dict[str, Any] = {"estimate_maps": True} if asked.estimate_maps else {}
    only = [each.strip() for each in asked.only.split(",")] if asked.only else []
    which = asked.which
    if which == "auto":
        which = hyst.online.name_of_estimator(model, only)
    # The one of the model's own constants starts wider, since it has no other start to try.
    spread = None if which == "model" else _SPREAD
    if asked.estimate_maps and asked.which in ("scale", "model"):
        raise hyst.InputError("--estimate-maps is for --estimator joint; leave one of them out")
    return hyst.online.estimator_for(
        model.at_sample_time(dt).with_description(model.description),
        dt=dt,
        memory=math.inf if asked.memory is None else asked.memory,
        spread=spread if asked.spread is None else asked.spread,
        only=only,
        # Maps are what the joint estimator alone knows; it says so of a model without plays.
        estimator="joint" if asked.estimate_maps else which,
        **options,
    )


def resumed(path: Path, model_file: Path | None, asked: Asked) -> Found:
    """Give the estimator of an earlier run, and the model that says what its numbers mean.

    Parameters
    ----------
    path
        What ``hyst adapt`` has written.
    model_file
        The model it started from or ended with, if that was given.
    asked
        What was typed.

    Raises
    ------
    InputError
        If it is another model, no estimator, or options of a start were typed.
    """
    if any(asked.of_a_start.values()):
        typed = [name for name, is_typed in asked.of_a_start.items() if is_typed]
        raise hyst.InputError(
            f"{path} has its own memory, spread and constants; leave out {' and '.join(typed)} "
            "with --resume"
        )
    found = hyst.load(path)
    inverse = found if isinstance(found, hyst.online.AdaptiveInverse) else None
    estimator = found if inverse is None else inverse.estimator
    if not isinstance(estimator, hyst.online.Estimator):
        raise hyst.InputError(f"{path} holds no estimator; give one that hyst adapt wrote")
    if inverse is not None and asked.window != "auto":
        raise hyst.InputError(f"{path} has its own window; leave out --window with --resume")
    if model_file is None:
        return Found(estimator, inverse, estimator.model)
    given = load_operator(model_file)
    known = (estimator.settings.get("model"), estimator.model.to_dict())
    if given.to_dict() not in known:
        raise hyst.InputError(
            f"{model_file} is not the model that {path} started from or ended with; leave the "
            "model out to go on, or --resume to start anew from it"
        )
    return Found(estimator, inverse, given)


def guarded(
    estimator: hyst.online.Estimator, asked: Asked, despite_verdict: bool = True
) -> hyst.online.AdaptiveInverse:
    """Put a guard around an estimator.

    Nothing is driven by what it would have commanded, so a verdict is told and not refused.

    Raises
    ------
    InputError
        If the window is no number above 0.
    NotInvertibleError
        If the model has no exact inverse.
    """
    window = None
    if asked.window != "auto":
        try:
            window = as_positive(float(asked.window), "--window", "seconds, or auto")
        except ValueError as error:
            if isinstance(error, hyst.InputError):
                raise
            raise hyst.InputError(f"--window is {asked.window!r}; give seconds, or auto") from None
    return hyst.online.AdaptiveInverse(estimator, window, despite_verdict=despite_verdict)
