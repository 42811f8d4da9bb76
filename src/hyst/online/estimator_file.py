"""Files of estimators, every double exact, and refusals of states that none can have reached."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.online.joint.parts import Parts
from hyst.online.joint.start import falling_map
from hyst.operators import ModelDescription
from hyst.operators.model_file import ESTIMATOR, write_file

Array = NDArray[np.float64]

_AGAIN = "which no estimator reaches; save the estimator again"
_ROUNDING = 1e-9


class Saved(ABC):
    """An estimator that can be saved, copied and sent to another process as it is.

    ``description`` says what the numbers of its model mean; ``kind`` is its name in files, by which
    ``kinds`` finds it again.
    """

    kind: ClassVar[str]
    description: ModelDescription
    kinds: ClassVar[dict[str, type[Saved]]] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "kind" in cls.__dict__:
            Saved.kinds[cls.kind] = cls

    @abstractmethod
    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the estimator."""

    @classmethod
    @abstractmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> Self:
        """Rebuild an estimator from what ``saved`` gave.

        Parameters
        ----------
        settings, state
            As in the file.

        Raises
        ------
        InputError
            If the state does not fit the settings, or holds an inadmissible estimate.
        """

    @final
    def save(
        self, path: str | os.PathLike[str], description: ModelDescription | None = None
    ) -> None:
        """Write settings and state, every double exact; ``hyst.load`` goes on with the same bits.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.
        description
            What the model's numbers mean; that of the estimator itself if left out.

        Raises
        ------
        InputError
            If the folder does not exist, or the state has an entry that is not finite.
        """
        settings, state = self.saved()
        if not np.isfinite(state).all():
            raise InputError(
                f"{path} cannot hold the state, in which the last samples led to an overflow; "
                "save it after more samples of ordinary size"
            )
        content = {"kind": self.kind, "settings": settings, "state": state.tolist()}
        about = self.description if description is None else description
        write_file(path, ESTIMATOR, content, about)

    @final
    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (type(self), *self.saved(), self.description)


def restored(
    kind: type[Saved], settings: dict[str, Any], state: ArrayLike, description: ModelDescription
) -> Any:
    """Give an estimator of a ``kind`` back, with ``settings``, ``state`` and ``description``."""
    estimator = kind.restore(settings, state)
    estimator.description = description
    return estimator


def restored_state(live: Array, saved: ArrayLike) -> None:
    """Copy a saved state into the live one.

    Parameters
    ----------
    live
        Shape (length,), overwritten.
    saved
        As many finite numbers.

    Raises
    ------
    InputError
        If there are more or fewer, or one is not finite.
    """
    given = np.asarray(saved, dtype=np.float64)
    if given.shape != live.shape or not np.isfinite(given).all():
        raise InputError(
            f"the saved state has {given.size} entries, {live.size} finite ones are needed; "
            "save the estimator again"
        )
    live[:] = given


def check_saved(
    parts: Parts, settings: dict[str, Any], state: Array, at: Mapping[str, int]
) -> None:
    """Refuse a saved state that no joint estimator can have reached.

    Parameters
    ----------
    parts
        The model.
    settings
        Of the estimator: bounds and patience.
    state
        Shape (length,).
    at
        Places in the state.

    Raises
    ------
    InputError
        If radii are out of order or bounds, p0 or a sum of weights is not within the bounds of the
        slope, a map cannot be inverted, a variance is negative, or the memory is none that an input
        leaves; for the estimate and for the rival on trial.
    """
    stages = state[at["scalars"] : at["scalars"] + 3]
    _check_estimate(parts, settings, state, at)
    has_cells = at["rival"] < at["cells"]
    if not has_cells:
        return
    points = at["points"] - at["cell_memory"]
    if stages[0] not in (0.0, 1.0, 2.0) or not 0.0 <= stages[2] <= points:
        raise InputError(f"the saved search is at stage {stages[0]:.6g}, {_AGAIN}")
    count = points + 2
    d = state[at["cells"] + count : at["cells"] + 2 * count]
    if (d < 0.0).any():
        raise InputError(f"the saved search has a negative variance, {_AGAIN}")
    if stages[0] == 2.0:
        _check_estimate(parts, settings, state[at["rival"] : at["cells"]], at)


def _check_estimate(
    parts: Parts, settings: dict[str, Any], state: Array, at: Mapping[str, int]
) -> None:
    theta, n = state[at["theta"] : at["d"]], parts.pi.p.size
    check_saved_radii(theta[n + 1 : 2 * n + 1], settings["most_radius"])
    least, most = settings["least_slope"], settings["most_slope"]
    slopes, reach = np.cumsum(theta[: n + 1]), np.cumsum(np.abs(theta[: n + 1]))
    # Sums of an estimate on its bounds are exact to rounding only; p0 is exact.
    rounding = 4.0 * np.arange(n + 1) * np.finfo(np.float64).eps * reach
    bad = np.flatnonzero((slopes < least - rounding) | (slopes > most + rounding))
    if bad.size:
        k = int(bad[0])
        name = "p0" if k == 0 else f"the sum of weights up to p[{k}]"
        raise InputError(
            f"the saved estimate has {name} = {slopes[k]:.6g}, outside {least:.6g} to {most:.6g}, "
            f"{_AGAIN}"
        )
    try:
        parts.assemble(theta, parts.pi.z0).inverse()
    except (InputError, NotInvertibleError) as error:
        raise InputError(f"the saved estimate cannot be inverted: {error}") from None
    if falling_map(parts, theta):
        raise InputError(
            f"the saved estimate has a {falling_map(parts, theta)} map that falls, {_AGAIN}"
        )
    _check_uncertainty(state, at)
    _check_memory(parts, settings, state, at)


def _check_uncertainty(state: Array, at: Mapping[str, int]) -> None:
    d, noise = state[at["d"] : at["u"]], float(state[2])
    if (d < 0.0).any():
        raise InputError(f"the saved estimate has the variance {d.min():.6g}, {_AGAIN}")
    if not noise > 0.0:
        raise InputError(f"the saved estimate has the noise variance {noise:.6g}, {_AGAIN}")


def _check_memory(
    parts: Parts, settings: dict[str, Any], state: Array, at: Mapping[str, int]
) -> None:
    n = parts.pi.p.size
    theta, z = state[at["theta"] : at["d"]], state[at["z"] : at["side"]]
    side, age = state[at["side"] : at["age"]], state[at["age"] : at["home"]]
    patience = settings["patience"] / settings["dt"]
    if not np.isin(side, (-1.0, 0.0, 1.0)).all() or (age < 0.0).any() or (age > patience + 1).any():
        raise InputError(f"the saved memory has plays on no side, or ages out of range, {_AGAIN}")
    if state[3] not in (0.0, 1.0) or (state[5:8] < 0.0).any():
        raise InputError(f"the saved estimate has counts below 0, {_AGAIN}")
    if state[3] == 0.0 or n == 0:
        return
    v = np.array([state[4]])
    if parts.front is not None:
        first = 2 * n + 2
        weights = theta[first : first + parts.front.weights.size]
        v = parts.front.with_weights(weights)(v)
    gaps = np.diff(theta[n + 1 : 2 * n + 1], prepend=0.0)
    steps = np.abs(np.diff(z, prepend=float(v[0])))
    slack = _ROUNDING * (1.0 + float(np.abs(z).max()) + abs(float(v[0])))
    if (steps > gaps + slack).any():
        k = int(np.argmax(steps - gaps)) + 1
        raise InputError(
            f"the saved memory has play {k} farther from the one before than radii allow, {_AGAIN}"
        )


def check_saved_radii(r: Array, most_radius: float) -> None:
    """Refuse saved radii that no estimator can have reached.

    Parameters
    ----------
    r
        Shape (n,), input units.
    most_radius
        Their bound, input units.

    Raises
    ------
    InputError
        If they do not ascend from 0 or more to ``most_radius`` or less.

    Examples
    --------
    >>> check_saved_radii(np.array([0.0, 1.0, 1.0]), 2.0)
    """
    steps = np.diff(np.concatenate([[0.0], r, [most_radius]]))
    if (steps < 0.0).any():
        k = int(np.argmax(steps < 0.0))
        below = "0" if k == 0 else f"r[{k}] = {r[k - 1]:.6g}"
        text = (
            f"r[{k + 1}] = {r[k]:.6g} below {below}"
            if k < r.size
            else f"{below} above most_radius = {most_radius:.6g}"
        )
        raise InputError(
            f"the saved estimate has {text}, which no estimator reaches; save the estimator again"
        )
