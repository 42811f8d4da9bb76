"""What an estimator knows, and whether its estimate is the best fit to that."""

from __future__ import annotations

from hyst.online.estimator import Estimator
from hyst.online.joint.joint_estimator import JointEstimator
from hyst.online.knowledge import Knowledge


def knowledge_of(estimator: Estimator) -> Knowledge:
    """Ask an estimator what it knows, whatever that costs.

    Parameters
    ----------
    estimator
        Any.
    """
    return estimator.knowledge


def at_better_fit(estimator: Estimator, knowledge: Knowledge) -> Knowledge:
    """Take an estimate out of a false minimum, for nobody stands beside a watch who could.

    What leaves more than noise is none to go to: of a plant that drifts it is the middle of what
    that was.

    Parameters
    ----------
    estimator
        It is changed where its parameters lie outside the bands of a better fit.
    knowledge
        What it knows now.

    Returns
    -------
    Knowledge
        What it knows then.
    """
    value = estimator.parameters
    is_within = bool(((knowledge.low <= value) & (value <= knowledge.high)).all())
    if is_within or knowledge.doubts or not isinstance(estimator, JointEstimator):
        return knowledge
    return estimator.knowledge if estimator.refine() else knowledge
