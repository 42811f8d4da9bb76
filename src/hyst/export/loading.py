"""Read whatever can be exported back from its file."""

from __future__ import annotations

import json
import os
from pathlib import Path

from hyst.control.tracking_controller import KIND, TrackingController
from hyst.errors import InputError
from hyst.export.c.block import Model
from hyst.models.model_loading import load_described
from hyst.online import JointEstimator
from hyst.online.loading import load_described_estimator
from hyst.online.saving import FORMAT
from hyst.operators import ModelDescription
from hyst.operators.model_file import read_model


def load_exportable(
    path: str | os.PathLike[str],
) -> tuple[Model, ModelDescription]:
    """Read an operator, a tracking controller or a joint estimator, and what its numbers mean.

    Parameters
    ----------
    path
        A file that ``save`` wrote.

    Returns
    -------
    model : Operator, TrackingController or JointEstimator
    description : ModelDescription

    Raises
    ------
    InputError
        If the file is not there, holds something else, or an entry is missing, unknown or not
        allowed.
    """
    if _holds_estimator(Path(path)):
        estimator, about = load_described_estimator(path)
        if not isinstance(estimator, JointEstimator):
            raise InputError(
                f"{path} is of kind {type(estimator).__name__}, which runs in Python only; export "
                "a joint estimator, or the model it has found"
            )
        return estimator, about
    model, about = read_model(path)
    if isinstance(model, dict) and model.get("kind") == KIND:
        return TrackingController.load(path), about
    return load_described(path)


def _holds_estimator(path: Path) -> bool:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False  # read_model says what is wrong
    return isinstance(content, dict) and content.get("format") == FORMAT
