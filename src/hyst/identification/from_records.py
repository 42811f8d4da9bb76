"""The main job of hyst: from records to a model that can be inverted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal

from numpy.typing import ArrayLike
from threadpoolctl import threadpool_limits

from hyst.identification.assembly import traced
from hyst.identification.data import require_same_units
from hyst.identification.hammerstein.from_options import (
    HAMMERSTEIN,
    identify_with_dynamics,
    require_usable,
)
from hyst.identification.identified import Identified
from hyst.identification.options import Options, as_radii, as_rule
from hyst.identification.rate_dependent import RDPI, identify_rate_dependent
from hyst.identification.rate_independent import identify_rate_independent
from hyst.identification.separable import PowerLawOptions
from hyst.operators.provenance import options_asked
from hyst.signals import Record


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
    period: int | None = None,
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
    period
        Only with ``family="hammerstein"`` and a periodic drive: samples of a period. All periods
        but the first are averaged, and the average identified from.
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
    asked = options_asked(identify, locals())
    say, given, judged = progress or _silent, _listed(records), _listed(validation)
    require_same_units((*given, *judged))
    require_usable(family, hysteresis, period)
    with threadpool_limits(1, user_api="blas"):
        # Matrices of a few dozen columns: a second BLAS thread costs more than it gives.
        if family == HAMMERSTEIN:
            dynamic = identify_with_dynamics(
                given,
                hysteresis=hysteresis,
                orders=(fir_order, state_order),
                plays=plays,
                radii=None if radii is None else as_radii(radii),
                knots=knots,
                weights=as_rule(weights),
                delay=delay,
                start=start,
                period=period,
                validation=judged,
                limits=(max_iterations, allow_unconverged),
                say=say,
            )
            return traced(dynamic, given, asked)
        common: dict[str, Any] = {"plays": plays, "radii": radii, "delay": delay, "start": start}
        common |= {"max_iterations": max_iterations, "allow_unconverged": allow_unconverged}
        if family == RDPI:
            common |= {"spacing": spacing, "record_weights": record_weights}
            common |= {"validation": judged, "progress": progress}
            return traced(identify_rate_dependent(given, **common), given, asked)
        power_law = PowerLawOptions(memory, regression, signal_to_noise)
        options = Options(knots, weights, power_law, judged, say, **common)
        return traced(identify_rate_independent(given, family, options), given, asked)


def _listed(records: Record | Sequence[Record]) -> tuple[Record, ...]:
    return (records,) if isinstance(records, Record) else tuple(records)


def _silent(_: str) -> None:
    """Report progress to nobody."""
