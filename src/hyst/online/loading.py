"""Read an estimator back."""

from __future__ import annotations

import json
import os
from pathlib import Path

from hyst.errors import InputError
from hyst.online.joint.adaptive_inverse import AdaptiveInverse
from hyst.online.joint.joint_estimator import JointEstimator
from hyst.online.radius_estimator import RadiusEstimator
from hyst.online.saving import FORMAT, VERSION
from hyst.operators import ModelDescription

Estimator = AdaptiveInverse | JointEstimator | RadiusEstimator


def load_estimator(path: str | os.PathLike[str]) -> Estimator:
    """Read an estimator back; it continues with the same bits as if it had never stopped.

    Parameters
    ----------
    path
        A file that ``save`` of an estimator or of an adaptive inverse wrote.

    Returns
    -------
    JointEstimator, RadiusEstimator or AdaptiveInverse

    Raises
    ------
    InputError
        If the file is not there, is no such file, is of another version, or was damaged.
    """
    return load_described_estimator(path)[0]


def load_described_estimator(
    path: str | os.PathLike[str],
) -> tuple[Estimator, ModelDescription]:
    """Read an estimator back, and what its model's numbers mean.

    Parameters
    ----------
    path
        As for ``load_estimator``.

    Returns
    -------
    estimator : JointEstimator, RadiusEstimator or AdaptiveInverse
    description : ModelDescription
        As it was saved with the estimator; nothing but defaults if it was not.

    Raises
    ------
    InputError
        If the file is not there, is no such file, is of another version, or was damaged.
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot be read as an estimator: {error}") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise InputError(f"{path} is no estimator; give a file that save() of an estimator wrote")
    if content.get("version") != VERSION:
        raise InputError(
            f"{path} has version {content.get('version')!r} of the format, this hyst reads "
            f"{VERSION}; use the hyst that wrote it"
        )
    kinds: dict[str, type[Estimator]] = {
        "joint": JointEstimator,
        "radius": RadiusEstimator,
        "inverse": AdaptiveInverse,
    }
    try:
        estimator = kinds[content["kind"]].restore(content["settings"], content["state"])
        return estimator, ModelDescription(**content.get("description", {}))
    except InputError:
        raise
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path} is damaged ({error}); save the estimator again") from None
