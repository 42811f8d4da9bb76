"""Read back whatever hyst saves; what reads a file is loaded when there is such a file."""

from __future__ import annotations

import os
from typing import Any

from hyst.errors import InputError
from hyst.operators.description import ModelDescription
from hyst.operators.model_file import ESTIMATOR, LEARNING, read_file

_BLOCKS = {
    "limited-drive": "LimitedDrive",
    "limited-schedule": "LimitedSchedule",
    "repetitive-controller": "RepetitiveController",
    "tracking-controller": "TrackingController",
}


def load(path: str | os.PathLike[str]) -> Any:
    """Read back what ``save`` wrote: an operator, a scheduled model, a controller or an estimator.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Operator, Scheduled, LimitedDrive, LimitedSchedule, TrackingController,
    RepetitiveController, LearningCompensator, or an estimator of hyst.online or its AdaptiveInverse
        Equal to the one saved, every double exact; an estimator goes on with the same bits. What
        its numbers mean is its ``description``.

    Raises
    ------
    InputError
        If the file is not there, is none of hyst's, is of another version, or an entry is missing,
        unknown or not allowed.

    Examples
    --------
    >>> import hyst, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     hyst.Play(0.5).save(f"{folder}/play.json", hyst.ModelDescription(input_unit="V"))
    ...     found = load(f"{folder}/play.json")
    >>> found == hyst.Play(0.5), found.description.input_unit
    (True, 'V')
    """
    saved = read_file(path)
    try:
        if saved.format is ESTIMATOR:
            return _estimator(saved.content, saved.description)
        if saved.format is LEARNING:
            return _learning(saved.content["learning"], saved.description)
        return _model(saved.content["model"]).with_description(saved.description)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except RecursionError:
        raise InputError(f"{path}: operators are nested too deeply; compose them flat") from None


def _model(data: Any) -> Any:
    import hyst.models  # from here on its classes are known

    if isinstance(data, dict) and str(data.get("kind")) in _BLOCKS:
        import hyst.control

        return getattr(hyst.control, _BLOCKS[data["kind"]]).from_dict(data)
    from hyst.operators import operator_from_dict

    if isinstance(data, dict) and data.get("kind") == hyst.models.Scheduled.kind:
        return hyst.models.Scheduled.from_dict(data)
    return operator_from_dict(data)


def _learning(data: Any, about: ModelDescription) -> Any:
    from hyst.compensation import LearningCompensator

    return LearningCompensator.from_dict(data, about)


def _estimator(content: dict[str, Any], about: ModelDescription) -> Any:
    # With the package all its kinds are known, and the models that it starts from.
    from hyst.online.estimator_file import Saved, restored

    try:
        kind = Saved.kinds[content["kind"]]
        return restored(kind, content["settings"], content["state"], about)
    except InputError:
        raise
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"the estimator is damaged ({error}); save it again") from None
