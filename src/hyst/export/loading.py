"""Read whatever can be exported back from its file."""

from __future__ import annotations

import os

from hyst.control.tracking_controller import KIND, TrackingController
from hyst.export.block import Model
from hyst.models.model_loading import load_described
from hyst.operators import ModelDescription
from hyst.operators.model_file import read_model


def load_exportable(path: str | os.PathLike[str]) -> tuple[Model, ModelDescription]:
    """Read an operator or a tracking controller, and what its numbers mean.

    Parameters
    ----------
    path
        A file that ``save`` wrote.

    Returns
    -------
    model : Operator or TrackingController
    description : ModelDescription

    Raises
    ------
    InputError
        If the file is not there, holds something else, or an entry is missing, unknown or not
        allowed.
    """
    model, about = read_model(path)
    if isinstance(model, dict) and model.get("kind") == KIND:
        return TrackingController.load(path), about
    return load_described(path)
