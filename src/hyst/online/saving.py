"""Files of estimators: settings and state, every double exact."""

from __future__ import annotations

import json
import os
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.files import replacing
from hyst.operators import ModelDescription

Array = NDArray[np.float64]

FORMAT = "hyst estimator"
# 2: a search beside the joint estimate.
VERSION = 2


def save_estimator(
    path: str | os.PathLike[str],
    kind: str,
    settings: dict[str, Any],
    state: Array,
    description: ModelDescription | None = None,
) -> None:
    """Write an estimator to a file of JSON, whole or not at all.

    Parameters
    ----------
    path
        The file to create or replace.
    kind
        ``joint``, ``radius`` or ``inverse``.
    settings
        Arguments of the constructor.
    state
        The state.
    description
        What the numbers of the model mean, if that is known.

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
    if description is not None:
        content["description"] = asdict(description)
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
