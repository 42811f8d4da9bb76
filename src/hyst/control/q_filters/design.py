"""Design of a classical Q-filter: one time constant, searched on the exact norm."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from hyst.checks.numbers import as_positive, whole_number
from hyst.control.q_filters.certificate import certify_filter
from hyst.control.q_filters.family import LARGEST_ORDER, QFilter, q_filter
from hyst.control.q_filters.free_search import FreeSearch
from hyst.control.q_filters.problem import QFilterProblem, q_filter_problem
from hyst.control.q_filters.result import QFilterObserver
from hyst.control.q_filters.textbook import time_constant_search
from hyst.errors import InputError

FAMILIES = ("textbook", "free")
OBJECTIVES = ("stacked", "robust")
_MORE_NOISE = 1.5  # than at frequency 0: what a free filter may amplify
_AUTO_MORE = 3  # orders tried above the least
_WORTH = 0.02  # an order more is taken for that much less of the norm


def design_q_filter(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    order: int | str | None = None,
    relative_degree: int | None = None,
    *,
    family: str = "textbook",
    most_noise: float | None = None,
    objective: str = "stacked",
) -> QFilterObserver:
    r"""Find the Q-filter that rejects most within a given uncertainty.

    ``min over tau of || [Wu T; Wp (1 - Q)] ||_inf`` for the filters of S1 eq. 28 with binomial
    coefficients, or over all coefficients of a free filter of given order and relative degree.

    Systems are transfer functions or state spaces of python-control, pairs (num, den), matrices
    (A, B, C, D) or numbers, in continuous time, with one input and one output. A zero of the plant
    that is not in the open left half plane is kept as a zero of Q, for Q/Pn must be stable; the
    summary says which.

    Parameters
    ----------
    plant
        Nominal plant Pn: stable.
    controller
        C, in u = C (y_ref - y); stabilizes Pn.
    Wu
        Weight of the multiplicative uncertainty, P = Pn (1 + Delta), |Delta| <= |Wu|; stable.
    Wp
        Weight of 1 - Q, what is left of the disturbance; stable.
    order
        m; ``"auto"`` tries from the least to three more and takes one more where it lowers the
        norm by a fiftieth; one above the least if left out.
    relative_degree
        rho, at least that of the plant. If left out, the largest there is for the textbook filter,
        1/(tau s + 1)^m, and that of the plant, at least 1, for the free one.
    family
        ``"textbook"`` or ``"free"``.
    most_noise
        Bound on the largest |Q/Pn|. If left out there is none for the textbook filter, and for the
        free one 1.5/|Pn(0)|, or what the textbook filter of that order has if that is more.
    objective
        ``"stacked"``, the norm above, or ``"robust"``, the largest |Wp (1 - Q)| + |Wu T|, which
        below 1 rejects for every plant within Wu; ``robust_performance`` says what that means.

    Returns
    -------
    QFilterObserver
        Also when gamma is above 1: ``feasible`` and ``message`` say so.

    Raises
    ------
    InputError
        If a system cannot be used, the order is too low for the relative degree of the plant and
        the zeros Q must keep, or no filter keeps noise below its bound.

    Source
    ------
    El-Shaer, Al Janaideh, Krejci and Tomizuka 2013, sec. 4.3.

    Examples
    --------
    >>> w = 565.5
    >>> plant = ([w * w], [1.0, 1.6 * w, w * w])
    >>> Wu = ([1.0, 960.0, 0.0], [1.0, 960.0, 5.76e6])
    >>> Wp = ([0.5, 201.1], [1.0, 0.2])
    >>> found = design_q_filter(plant, ([4.0, 8.0], [1.0, 0.0]), Wu, Wp)
    >>> found.name, round(found.gamma, 2)
    ('1/(tau s + 1)^3', 0.95)
    """
    if family not in FAMILIES:
        raise InputError(f"family is {family!r}; give one of {', '.join(FAMILIES)}")
    if objective not in OBJECTIVES:
        raise InputError(f"objective is {objective!r}; give one of {', '.join(OBJECTIVES)}")
    problem = q_filter_problem(plant, controller, Wu, Wp)
    bound = None if most_noise is None else as_positive(most_noise, "most_noise", "a gain of Q/Pn")
    wanted = _Wanted(problem, bound, objective == "robust")
    with threadpool_limits(1, user_api="blas"):
        if order == "auto":
            return _best_order(wanted, relative_degree, family)
        m, rho = degrees(problem, order, relative_degree, family)
        return _one(wanted, m, rho, family)


@dataclass(frozen=True)
class _Wanted:
    """What does not depend on the order: the problem, a bound on noise, what is minimized."""

    problem: QFilterProblem
    most_noise: float | None
    robust: bool

    def value(self, design: QFilterObserver) -> float:
        c = design.certificate
        return c.robust_performance if self.robust else c.stacked_norm


def degrees(
    problem: QFilterProblem, order: int | str | None, relative_degree: int | None, family: str
) -> tuple[int, int]:
    """Give order and relative degree of the filter, or refuse what the plant does not allow.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    order, relative_degree, family
        As for ``design_q_filter``.

    Raises
    ------
    InputError
        If the order leaves no room for the relative degree of the plant and the zeros Q must keep.
    """
    least, kept = max(problem.plant_relative_degree, 1), int(problem.kept_zeros.size)
    if order is None:
        m = least + kept + 1
        if relative_degree is not None:
            m = max(m, relative_degree + kept)
    else:
        m = whole_number(order, "order", 1, LARGEST_ORDER)
    if relative_degree is None:
        rho = m - kept if family == "textbook" else min(least, m - kept)
    else:
        rho = whole_number(relative_degree, "relative_degree", 1, LARGEST_ORDER)
    if rho < least:
        raise InputError(
            f"the filter has relative degree {rho}, below {least} of the plant, so Q/Pn cannot be "
            f"realized; give order {least + kept} and relative degree {least} at least"
        )
    if rho + kept > m:
        raise InputError(
            f"relative degree {rho} and {kept} kept zeros need order {rho + kept} at least, not "
            f"{m}; raise the order"
        )
    return m, rho


def _one(wanted: _Wanted, m: int, rho: int, family: str) -> QFilterObserver:
    problem, bound = wanted.problem, wanted.most_noise
    least = 1.0 / float(abs(problem.plant_factors.response(np.zeros(1, complex))[0]))
    if bound is not None and bound < least * (1.0 - 1e-9):
        raise InputError(
            f"no filter keeps |Q/Pn| below {bound:.4g}: at 0 it is 1/|Pn(0)| = {least:.4g}, for "
            "Q(0) = 1; allow more noise"
        )
    kept = problem.kept_zeros
    if family == "free":
        textbook = _textbook(replace(wanted, most_noise=None), m, m - kept.size)
        most = max(_MORE_NOISE * least, textbook.certificate.observer_noise_gain)
        most = most if bound is None else bound
        search = FreeSearch(problem, rho, textbook.tau or 1.0, most, wanted.robust)
        Q = search.run(m)
        step = f"search         {search.descents} descents, |Q/Pn| bounded by {most:.4g}"
        found = QFilterObserver(problem, Q, certify_filter(problem, Q), family, (step,))
    else:
        found = _textbook(wanted, m, rho)
        most = np.inf if bound is None else bound
    noise = found.certificate.observer_noise_gain
    if noise > most * (1.0 + 1e-4):
        raise InputError(
            f"no filter of order {m} and relative degree {rho} was found that keeps |Q/Pn| below "
            f"{most:.4g}; {noise:.4g} at best, so allow more noise"
        )
    return found


def _textbook(wanted: _Wanted, m: int, rho: int) -> QFilterObserver:
    problem, kept = wanted.problem, wanted.problem.kept_zeros

    def of_tau(tau: float) -> QFilter:
        return q_filter(m, tau=tau, relative_degree=rho, kept_zeros=kept)

    search = time_constant_search(problem, of_tau, wanted.most_noise, wanted.robust)
    Q = of_tau(search.run()[0])
    step = f"search         {search.evaluations} exact norms, tau = {Q.tau:.6g} s"
    return QFilterObserver(problem, Q, certify_filter(problem, Q), "textbook", (step,))


def _best_order(wanted: _Wanted, relative_degree: int | None, family: str) -> QFilterObserver:
    m, _ = degrees(wanted.problem, None, relative_degree, family)
    found = []
    for order in range(max(m - 1, 1), min(m + _AUTO_MORE, LARGEST_ORDER + 1)):
        try:
            m_rho = degrees(wanted.problem, order, relative_degree, family)
        except InputError:  # too low for a relative degree that was asked
            continue
        found.append(_one(wanted, *m_rho, family))
    best = found[0]
    for each in found[1:]:
        if wanted.value(each) < (1.0 - _WORTH) * wanted.value(best):
            best = each
    return best
