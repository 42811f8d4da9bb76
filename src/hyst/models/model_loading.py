"""Read a model file back into the operator it holds."""

from __future__ import annotations

import os

from hyst.errors import InputError
from hyst.operators.base import Operator
from hyst.operators.model_file import ModelDescription, read_model
from hyst.operators.registry import operator_from_dict


def load(path: str | os.PathLike[str]) -> Operator:
    """Read the operator of a model file that ``Operator.save`` wrote.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Operator
        Equal to the one saved, every double exact.

    Raises
    ------
    InputError
        If the file is not there, is no model file, or an entry is missing, unknown or not allowed.
    """
    return load_described(path)[0]


def load_described(path: str | os.PathLike[str]) -> tuple[Operator, ModelDescription]:
    """Read the operator of a model file and what its numbers mean.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    operator : Operator
    description : ModelDescription

    Raises
    ------
    InputError
        As ``load``.
    """
    model, description = read_model(path)
    try:
        return operator_from_dict(model), description
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except RecursionError:
        raise InputError(f"{path}: operators are nested too deeply; compose them flat") from None
