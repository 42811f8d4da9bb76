"""Fit any composition of operators to records, from its own constants."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, final

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.diagnose_records import diagnose_all_but_delay
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.blas_threads import one_blas_thread
from hyst.identification.choice.fits_from_starts import settled
from hyst.identification.dynamics_estimates import chain_of, estimates_of_chain
from hyst.identification.families.family import Estimates, Family, Fit, Start, Words
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import shortened
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.fit.chain_fit import fit_chain
from hyst.identification.fit.chain_parametrization import (
    ChainParametrization,
    chain,
    links_of,
)
from hyst.identification.fit.scales_between import Link
from hyst.identification.options import Options, as_delay, listed
from hyst.identification.progress import Progress, Step, silent
from hyst.identification.record_use.cleaned import as_drift, cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data, prepare, require_same_units
from hyst.identification.result.identified import Identified
from hyst.identification.result.identified_from_fit import identified_from_fit, traced
from hyst.models import LinearDynamics
from hyst.operators import Operator
from hyst.operators.parameters import Parameters
from hyst.operators.provenance import options_asked
from hyst.signals import Record

Array = NDArray[np.float64]
Bound = tuple[float, float]

MOST_SAMPLES = 50_000
"""On which a start of hysteresis with dynamics is improved before the last step takes all."""

MOST_NAMES = 12
"""In a message; beyond, the first ones are named."""


@final
@dataclass(frozen=True, eq=False)
class OwnModel(Family):
    """A model with the free parameters its user chose; it is in no registry.

    Parameters
    ----------
    parametrization, theta
        What is free, and the model's own values.
    """

    name = ""
    words = Words(full_name="model of your own", equations=(), explanations=())
    depends_on_rate = True  # nothing is known of it
    explains = ("rate dependence", "dynamics", "run direction", "butterfly")

    parametrization: ChainParametrization
    theta: Array

    def __post_init__(self) -> None:
        """Check nothing: it has no options."""

    def least_parameters(self, size: int) -> int:
        """Give the number of free parameters."""
        return self.parametrization.free_count

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Start from the model's own constants."""
        return [(self.parametrization, self.theta)]

    def estimates(self, fit: Fit) -> Estimates:
        """Give the constants that are free, and of dynamics what is known of them."""
        return estimates_of_chain(fit)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what is held, because no record shows it."""
        return chain_of(fit).sentences


def fit(
    model: Operator,
    records: Record | Sequence[Record],
    *,
    free: Iterable[str] | None = None,
    bounds: Mapping[str, Bound] | None = None,
    delay: float = 0,
    start: int | Literal["auto"] = "auto",
    drift: Literal["auto", False] = "auto",
    validation: Record | Sequence[Record] = (),
    max_iterations: int = 200,
    allow_unconverged: bool = False,
    progress: Callable[[Step], object] | None = None,
) -> Identified:
    """Fit the constants of any operator, from its own values, by the error of its output.

        min  sum_k (model[u](k) - y(k + delay))^2    over the constants that are free

    with analytic derivatives and bounds. The minimum is the one next to the start: ``identify``
    finds starts, this function does not. Only where linear dynamics are free as a whole, plays are
    moved out of the local minima that they make, and dynamics 10 % off will do.

    Parameters
    ----------
    model
        Any operator or composition; its constants are where the search starts, its initial state is
        kept.
    records
        One or more records of one actuator, with the sample time of the model if it has one.
    free
        Names of the constants that may move, as in ``model.parameters().names``; a name without its
        index, as ``"prandtl_ishlinskii.p"``, stands for all entries, that of a stage for all its
        constants. All if left out; the others keep their values. Linear dynamics whose stage is
        named, or of which all is free, move by as many numbers as there are (2n, and D unless it is
        0 and not named): they stay stable, and are told by frequencies, damping and coefficients;
        where no record shows their gain, it is held at that of the start.
    bounds
        By name, as for ``free``: lowest and highest value, in the constant's unit. A constant stays
        within its own bounds (``model.parameters()``) too.
    delay
        Samples by which the output lags the input, parts of one included.
    start, drift, validation, max_iterations, allow_unconverged, progress
        As in ``hyst.identify``.

    Returns
    -------
    Identified
        Its model is of the same kind as ``model``; constants that the records do not tell apart, as
        the gains of two stages in a row, have no standard error and are named.

    Raises
    ------
    InputError
        If the model is no operator, a name is unknown, nothing is free, bounds are upside down or
        exclude the model's own value or are of matrices of dynamics that are free as a whole, such
        dynamics are not stable or not moved by their input, a record has another sample time, or
        another argument cannot be used.
    NotIdentifiableError
        If a signal is constant, or there are no more samples than free constants.
    SolverError
        If it did not converge and ``allow_unconverged`` is false.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 500))
    >>> plays = hyst.PrandtlIshlinskii([0.4], [0.3], p0=1.0)
    >>> dynamics = hyst.LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], dt=1e-3)
    >>> record = hyst.Record(u, (dynamics @ plays)(u), dt=1e-3)
    >>> guess = dynamics @ hyst.PrandtlIshlinskii([0.2], [0.5], p0=0.8)
    >>> found = hyst.fit(guess, record, free=["prandtl_ishlinskii"])
    >>> found.model.parameters().values[:3].round(6)
    array([1. , 0.4, 0.3])
    """
    if not isinstance(model, Operator):
        raise InputError(f"the model is of type {type(model).__name__}; give an operator")
    asked = options_asked(fit, locals())
    given, judged = listed(records), listed(validation, "validation record")
    require_same_units((*given, *judged))
    parametrization, theta = parametrize_own(model, free, bounds or {})
    say = Progress(progress or silent)
    options = Options(judged, say, delay, start, max_iterations, allow_unconverged)
    say("diagnosis")
    diagnosis = diagnose_all_but_delay(given)
    clean = cleaned(given, diagnosis, as_drift(drift))
    data = clean.marked(prepare(clean.records, start, fewest_turns=0))
    data = data.delayed(as_delay(delay, data, ""))
    for record in (*given, *judged):
        model.require_sample_time(record.dt)
    with one_blas_thread():
        found = _fitted(OwnModel(parametrization, theta), data, options)
        say("verdict")
        told = identified_from_fit(data, found, (), judged, (), diagnosis)
    # With other constants it is of the family it was of.
    family = model.description.family
    about = replace(told.description, family=family)
    return traced(replace(told, family=family, description=about), given, asked)


def parametrize_own(
    model: Operator, free: Iterable[str] | None, bounds: Mapping[str, Bound]
) -> tuple[ChainParametrization, Array]:
    """Give the free constants of a model and their values.

    Parameters
    ----------
    model
        Any operator.
    free, bounds
        As of ``fit``.

    Returns
    -------
    Parametrization
    theta : numpy.ndarray

    Raises
    ------
    InputError
        As ``fit``.
    """
    own = model.parameters()
    places, whole = _free_places(model, own, free)
    lower, upper = own.lower.copy(), own.upper.copy()
    if not isinstance(bounds, Mapping):
        raise InputError(
            f"bounds is of type {type(bounds).__name__}; give a dict of two numbers by name"
        )
    for name, bound in bounds.items():
        low, high = _as_bound(name, bound)
        at = _places_of(own, name)
        _require_single(name, at, links_of(model, own, places), whole)
        lower[at], upper[at] = np.maximum(lower[at], low), np.minimum(upper[at], high)
    _require_start_within(own, lower, upper)
    return chain(model, places, whole, lower, upper)


def _fitted(family: OwnModel, data: Data, options: Options) -> Fit:
    samples, count = data.measured().size, family.least_parameters(0)
    if samples <= count:
        raise NotIdentifiableError(
            f"{samples} samples can be used but {count} constants are free; give a longer record "
            "or let fewer move"
        )
    options.say("fit", 0.1)
    unsolved = Fit(family, 0, family.parametrization, Solution(family.theta, np.inf, 0, ""))
    most = options.max_iterations
    if family.parametrization.dynamics:
        beginning = shortened(data, max(MOST_SAMPLES // len(data.records), 1))
        solution = fit_chain(family.parametrization, family.theta, data, most, beginning)
    else:
        solution = family.solve(unsolved.problem(data), family.theta, most)
    found = Fit(family, 0, family.parametrization, solution)
    return options.converged(settled(found, Overview(data), most))


def _free_places(
    model: Operator, own: Parameters, free: Iterable[str] | None
) -> tuple[list[int], list[int]]:
    """Give the places of constants that move one by one, and which stages move as a whole."""
    links = links_of(model, own, ())
    dynamics = {i: each for i, each in enumerate(links) if isinstance(each.stage, LinearDynamics)}
    if free is None:
        names, whole = list(own.names), list(dynamics)
    elif not isinstance(free, Iterable):
        raise InputError(f"free is of type {type(free).__name__}; give names of constants")
    else:
        names = [free] if isinstance(free, str) else list(free)
        whole = [i for i, each in dynamics.items() if each.name and each.name in names]
        names = [name for name in names if name not in {dynamics[i].name for i in whole}]
    single = {int(place) for name in names for place in _places_of(own, name)}
    for i in whole:
        matrices = set(range(links[i].constant, links[i].constant + links[i].free.size))
        # Of a stage that is free as a whole, D says whether it may leave 0.
        single -= matrices if free is None else matrices - {max(matrices)}
    if not single and not whole:
        raise InputError("no constant is free; name at least one, or leave out free for all")
    return sorted(single), whole


def _require_single(
    name: str, at: NDArray[np.intp], links: Sequence[Link], whole: Sequence[int]
) -> None:
    """Refuse bounds of entries of matrices that are no constants of the fit."""
    for i in whole:
        first = links[i].constant
        if ((at >= first) & (at < first + links[i].free.size)).any():
            raise InputError(
                f"{name} has bounds, but its dynamics are fitted as a whole, in which the entries "
                "of their matrices are no free constants; bound other constants, or name the "
                "single entries that may move in free"
            )


def _places_of(own: Parameters, name: str) -> NDArray[np.intp]:
    """Give the places of one constant, of all entries of an array, or of a stage."""
    found = [
        place
        for place, each in enumerate(own.names)
        if each == name or each.startswith((f"{name}[", f"{name}."))
    ]
    if not found:
        shown = ", ".join(own.names[:MOST_NAMES])
        more = f" and {len(own) - MOST_NAMES} more" if len(own) > MOST_NAMES else ""
        raise InputError(f"the model has no constant {name!r}; it has {shown}{more}")
    return np.array(found, dtype=np.intp)


def _as_bound(name: str, bound: Bound) -> Bound:
    try:
        low, high = (float(each) for each in bound)
    except (TypeError, ValueError):
        raise InputError(f"the bounds of {name} are {bound!r}; give two numbers") from None
    if not low < high:
        raise InputError(
            f"the bounds of {name} are {low:.6g} and {high:.6g}; give the lower one first, and "
            "leave a constant that is not to move out of free"
        )
    return low, high


def _require_start_within(own: Parameters, lower: Array, upper: Array) -> None:
    outside = np.flatnonzero((own.values < lower) | (own.values > upper))
    if outside.size:
        i = int(outside[0])
        raise InputError(
            f"{own.names[i]} is {own.values[i]:.6g} in the model, outside its bounds "
            f"{lower[i]:.6g} to {upper[i]:.6g}; the search starts from the model's own values, so "
            "widen the bounds or give a model within them"
        )
