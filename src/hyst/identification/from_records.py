"""The main job of hyst: from records to a model that can be inverted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from hyst.errors import InputError, NotIdentifiableError, SolverError
from hyst.identification.assembly import assemble
from hyst.identification.bounded_least_squares import CONVERGED
from hyst.identification.data import Data, prepare, require_same_units
from hyst.identification.delay import estimate_delay
from hyst.identification.families import (
    FAMILIES,
    KNOWN,
    LINEAR,
    PI,
    RAMBERG_OSGOOD,
    WITHOUT_PLAYS,
)
from hyst.identification.fitting import AUTO, MOST_STARTS, Fit, Fitter
from hyst.identification.hammerstein.from_options import HAMMERSTEIN, identify_with_dynamics
from hyst.identification.identified import Candidate, Identified
from hyst.identification.rate_dependent import RDPI, identify_rate_dependent
from hyst.identification.selection import SIZES, choose
from hyst.identification.separable import PowerLawOptions
from hyst.identification.weight_rules import RULES
from hyst.signals import Record

Array = NDArray[np.float64]

MOST_PLAYS = 200


def identify(
    records: Record | Sequence[Record],
    *,
    family: str = "auto",
    plays: int | Literal["auto"] = "auto",
    radii: ArrayLike | None = None,
    knots: int = 6,
    weights: str = "auto",
    memory: str = "masing",
    regression: str = "output",
    signal_to_noise: float = 3.0,
    spacing: str = "even",
    record_weights: str | ArrayLike = "equal",
    delay: int | Literal["auto"] = "auto",
    start: int | Literal["auto"] = "auto",
    hysteresis: str = "mpi",
    fir_order: int | Literal["auto"] = "auto",
    state_order: int | Literal["auto"] = "auto",
    validation: Record | Sequence[Record] = (),
    max_iterations: int = 200,
    allow_unconverged: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Identified:
    """Identify a hysteresis model, a constant offset and a whole-sample delay from records.

    Families: ``linear`` (a straight line), ``pi`` (Prandtl-Ishlinskii), ``gpi`` (an envelope map
    before the plays), ``mpi`` (a map after them), ``ramberg-osgood`` (three constants). Cumulative
    weights and the slopes of the maps are kept positive, so the result can always be inverted.

    Parameters
    ----------
    records
        One or more records of one actuator with one sample time. They are not joined: each has its
        own memory.
    family
        One family; several with commas between them, which are compared by blocked
        cross-validation, the simplest within one standard error of the best being taken; or
        ``"auto"``: all but ``ramberg-osgood``.
    plays
        Number of plays, 1 to 200, or ``"auto"``: chosen in the same way. Plays whose weight comes
        out zero are left out of the model.
    radii
        Shape (n,), input units: keep these radii instead of finding them.
    knots
        Number of knots of the map of ``gpi`` and ``mpi``, evenly spaced over the signal.
    weights
        ``"non-negative"``; ``"invertible"``: single weights may be negative as long as the
        cumulative ones are positive, for loops that flatten after a reversal, as friction's do; or
        ``"auto"``: the latter where it lowers the residual by more than a tenth.
    memory
        Of ``ramberg-osgood``: ``"masing"`` (nested reversals) or ``"last-reversal"``.
    regression
        Of ``ramberg-osgood``: ``"output"`` fits y; ``"slope"`` fits dy/du, as S3 does, which is
        more sensitive to noise and gives no standard errors.
    signal_to_noise
        With ``"slope"``: what a difference of y must be in units of its noise to take part.
    spacing
        Of ``rdpi``, the rate-dependent family for records at several frequencies: radii at rest
        ``"even"`` (multiples of the first) or ``"free"``.
    record_weights
        Of ``rdpi``: ``"equal"``, ``"hysteresis"`` (the hysteresis percent of each record over that
        of the first), or a positive number for each record.
    delay
        Whole samples by which the output lags the input, or ``"auto"``. The model is identified
        without it; ``Identified.predict`` adds it.
    start
        First sample to use. ``"auto"``: the first at which the memory is known whatever was before,
        because the input has passed its range; all samples with no memory before them if that would
        leave less than half of the record.
    hysteresis, fir_order, state_order
        Only with ``family="hammerstein"``, which identifies a hysteresis (``linear``, ``pi``,
        ``gpi``, ``mpi`` or ``ramberg-osgood``) and linear dynamics behind it: the last lag of the
        first step and the number of states, or ``"auto"``. The result is an
        ``IdentifiedHammerstein``; ``"auto"`` plays are 4.
    validation
        Records to judge the model by; they do not take part in the fit.
    max_iterations
        Of the final fit, for each of its starts.
    allow_unconverged
        Give the result with its status instead of raising if the fit did not converge.
    progress
        Called with a line of text before each step.

    Returns
    -------
    Identified

    Raises
    ------
    InputError
        If an argument or a record cannot be used.
    NotIdentifiableError
        If the input is constant or turns less than twice, or there are fewer samples than
        parameters.
    SolverError
        If the fit did not converge and ``allow_unconverged`` is false.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 2000)) * np.linspace(1.0, 0.5, 2000)
    >>> true = hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.1, 0.3], p0=1.0)
    >>> found = hyst.identify(hyst.Record(u, true(u), dt=1e-3), family="pi", plays=2)
    >>> bool(np.abs(found.model(u) - true(u))[500:].max() < 1e-6)
    True
    """
    say = progress or _silent
    require_same_units((*_listed(records), *_listed(validation)))
    if family == HAMMERSTEIN:
        with threadpool_limits(1, user_api="blas"):
            return identify_with_dynamics(
                records,
                hysteresis=hysteresis,
                orders=(fir_order, state_order),
                plays=plays,
                radii=None if radii is None else _as_radii(radii),
                knots=knots,
                weights=_as_rule(weights),
                delay=delay,
                start=start,
                validation=validation,
                limits=(max_iterations, allow_unconverged),
                say=say,
            )
    if family == RDPI:
        return identify_rate_dependent(
            records,
            plays=plays,
            radii=radii,
            spacing=spacing,
            record_weights=record_weights,
            delay=delay,
            start=start,
            validation=validation,
            max_iterations=max_iterations,
            allow_unconverged=allow_unconverged,
            progress=progress,
        )
    fixed = None if radii is None else _as_radii(radii)
    families, sizes = _as_families(family, fixed), _as_sizes(plays, fixed)
    with threadpool_limits(1, user_api="blas"):
        # Matrices of a few dozen columns: a second BLAS thread costs more than it gives.
        data = prepare(records, start, 0)
        say("delay")
        data = data.delayed(_as_delay(delay, data))
        fixed, left_out = _within_reach(fixed, data)
        sizes = sizes if fixed is None else (fixed.size,)
        power_law = PowerLawOptions(memory, regression, signal_to_noise)
        fitter = Fitter(data, _as_knots(knots), fixed, _as_rule(weights), power_law)
        _require_samples(data, families, sizes, knots)
        chosen_family, chosen_plays, candidates = _select(fitter, families, sizes, say)
        say(f"final fit: {chosen_family}")
        fit = _final_fit(fitter, chosen_family, chosen_plays, max_iterations)
        if fit.solution.status != CONVERGED and not allow_unconverged:
            raise SolverError(
                f"the fit of {chosen_family} with {chosen_plays} plays did not converge in "
                f"{fit.solution.iterations} iterations; raise max_iterations, give fewer plays, or "
                "accept it with allow_unconverged"
            )
        return assemble(fitter, fit, chosen_plays, candidates, _listed(validation), left_out)


def _listed(records: Record | Sequence[Record]) -> tuple[Record, ...]:
    return (records,) if isinstance(records, Record) else tuple(records)


def _silent(_: str) -> None:
    """Report progress to nobody."""


def _select(
    fitter: Fitter, families: Sequence[str], sizes: Sequence[int], say: Callable[[str], None]
) -> tuple[str, int, tuple[Candidate, ...]]:
    """Compare what there is to choose from; nothing if there is no choice."""
    if len(families) == 1 and (len(sizes) == 1 or families[0] in WITHOUT_PLAYS):
        return families[0], 0 if families[0] in WITHOUT_PLAYS else sizes[0], ()
    choice = choose(fitter, families, sizes, say)
    return choice.family, choice.plays, choice.candidates


def _final_fit(fitter: Fitter, family: str, plays: int, max_iterations: int) -> Fit:
    """Fit from all starts, then again without the plays that came out idle, until none is."""
    fit = fitter.fit(family, plays, MOST_STARTS, max_iterations)
    fit = fitter.improve(fit, max_iterations)
    while fitter.radii is None:
        working = _working_plays(fit, fitter.data)
        if working.all():
            break
        fit = fitter.refit(fit, working, max_iterations)
    return fit


def _working_plays(fit: Fit, data: Data) -> NDArray[np.bool_]:
    """Plays with a weight, and with a radius of their own."""
    weights = fit.parametrization.weights(fit.solution.theta)
    r = fit.parametrization.radii(fit.solution.theta)
    apart = np.diff(r, prepend=-np.inf) > 1e-4 * data.half_range
    return np.asarray((np.abs(weights[1:]) > 1e-6 * np.abs(weights).max()) & apart)


def _as_families(family: str, radii: Array | None) -> tuple[str, ...]:
    if family == "auto":
        return FAMILIES if radii is None else FAMILIES[1:]
    families = tuple(dict.fromkeys(each.strip() for each in family.split(",")))
    for each in families:
        if each not in KNOWN:
            known = ", ".join(("auto", *FAMILIES, RAMBERG_OSGOOD))
            raise InputError(f"unknown family {each!r}; choose one of {known}")
        if each in WITHOUT_PLAYS and radii is not None:
            raise InputError(f"family {each!r} has no plays; leave out radii")
    return families


def _as_sizes(plays: int | str, radii: Array | None) -> tuple[int, ...]:
    if radii is not None:
        if plays not in ("auto", radii.size):
            raise InputError(f"plays is {plays} but {radii.size} radii are given; leave out plays")
        return (radii.size,)
    if plays == "auto":
        return SIZES
    if isinstance(plays, bool) or not isinstance(plays, int | np.integer):
        raise InputError(f"plays is {plays!r}; give a number or 'auto'")
    if not 1 <= plays <= MOST_PLAYS:
        raise InputError(f"plays is {plays}; give 1 to {MOST_PLAYS}, or 'auto'")
    return (int(plays),)


def _as_radii(radii: ArrayLike) -> Array:
    values = np.unique(np.asarray(radii, dtype=np.float64))
    if values.size == 0 or not np.isfinite(values).all() or values[0] <= 0.0:
        raise InputError("radii must be one or more positive, finite numbers")
    return values


def _as_knots(knots: int) -> int:
    if isinstance(knots, bool) or not isinstance(knots, int | np.integer) or not 1 <= knots <= 50:
        raise InputError(f"knots is {knots!r}; give 1 to 50")
    return int(knots)


def _as_rule(weights: str) -> str:
    if weights not in (AUTO, *RULES):
        raise InputError(f"weights is {weights!r}; choose one of {', '.join((AUTO, *RULES))}")
    return weights


def _as_delay(delay: int | str, data: Data) -> int:
    if delay == "auto":
        return estimate_delay(data)
    shortest = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True))
    if isinstance(delay, bool) or not isinstance(delay, int | np.integer):
        raise InputError(f"delay is {delay!r}; give a number of samples or 'auto'")
    if not 0 <= delay < shortest:
        raise InputError(f"delay is {delay}; give 0 to {shortest - 1} samples, or 'auto'")
    return int(delay)


def _within_reach(radii: Array | None, data: Data) -> tuple[Array | None, tuple[str, ...]]:
    """Leave out radii the input never passes, saying so."""
    if radii is None:
        return None, ()
    reached = radii < data.half_range
    if not reached.any():
        raise NotIdentifiableError(
            f"no radius is below {data.half_range:.6g}, half the input range; a play that never "
            "moves cannot be identified"
        )
    return radii[reached], tuple(
        f"the play of radius {r:.6g} never moves: half the input range is {data.half_range:.6g}; "
        "it was left out"
        for r in radii[~reached]
    )


def _require_samples(data: Data, families: Sequence[str], sizes: Sequence[int], knots: int) -> None:
    samples = data.measured().size
    least = {LINEAR: 2, RAMBERG_OSGOOD: 4, PI: 2 * sizes[0] + 2}
    needed = min(least.get(family, 2 * sizes[0] + 2 + knots) for family in families)
    if samples <= needed:
        raise NotIdentifiableError(
            f"{samples} samples can be used but the model has {needed} parameters; give a longer "
            "record or fewer plays"
        )
