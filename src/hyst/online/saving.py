"""Files of estimators: settings and state, every double exact."""

from __future__ import annotations

import json
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.files import replacing

Array = NDArray[np.float64]

FORMAT = "hyst estimator"
VERSION = 1


def save_estimator(
    path: str | os.PathLike[str], kind: str, settings: dict[str, Any], state: Array
) -> None:
    """Write an estimator to a file of JSON, whole or not at all.

    Parameters
    ----------
    path
        The file to create or replace.
    kind
        ``joint`` or ``radius``.
    settings
        Arguments of the constructor.
    state
        The state.

    Raises
    ------
    InputError
        If the folder does not exist, or the state has an entry that is not finite.
    """
    if not np.isfinite(state).all():
        raise InputError(
            f"{path} cannot hold the state, in which the last samples led to an overflow; "
            "save it after more samples of ordinary size"
        )
    content = {
        "format": FORMAT,
        "version": VERSION,
        "kind": kind,
        "settings": settings,
        "state": state.tolist(),
    }
    with replacing(path) as temporary:
        temporary.write_text(
            json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8"
        )


def restored_state(live: Array, saved: list[float]) -> None:
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
