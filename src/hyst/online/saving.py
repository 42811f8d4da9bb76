"""Files of estimators: settings and state, every double exact."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from typing import Any, ClassVar, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError
from hyst.operators import ModelDescription
from hyst.operators.model_file import ESTIMATOR, write_file

Array = NDArray[np.float64]


class Saved(ABC):
    """An estimator that can be saved, copied and sent to another process as it is.

    ``description`` says what the numbers of its model mean.
    """

    kind: ClassVar[str]
    description: ModelDescription

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
