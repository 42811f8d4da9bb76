"""An estimator as C, whichever it is."""

from __future__ import annotations

from hyst.export.c.block import Block
from hyst.export.c.estimator import estimator_block
from hyst.export.c.numbers import Precision
from hyst.export.c.scale_estimator import scale_estimator_block
from hyst.online import JointEstimator, ScaleEstimator


def any_estimator_block(estimator: JointEstimator | ScaleEstimator, precision: Precision) -> Block:
    """Give what is exported of an estimator.

    Parameters
    ----------
    estimator
        It goes on from the estimate and the memory it has.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If it has no command, or a constant cannot be written in that precision.
    """
    if isinstance(estimator, JointEstimator):
        return estimator_block(estimator, precision)
    return scale_estimator_block(estimator, precision)
