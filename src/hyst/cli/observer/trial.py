"""What hyst observer tries: the block with each inverse, with and without the observer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import hyst
from hyst.cli.console import at_work, note, progress_bar
from hyst.operators.verdict import UNFIT

if TYPE_CHECKING:
    from hyst.cli.observer.spec import ObserverSpec
    from hyst.compensation import ErrorBound
    from hyst.control import (
        LoopComparison,
        LoopMargins,
        SampledCertificate,
        TrackingController,
        TriedLoop,
    )
    from hyst.report import ObserverAnswer, TruePlant

_STANDARD_ERRORS = 3.0
_NONE, _ALONE = "none", "controller alone"


def tried(spec: ObserverSpec, design: Any, stress: int | None) -> ObserverAnswer:
    """Try a design as it runs, and collect what is known of it.

    Parameters
    ----------
    spec
        What was asked for.
    design
        The observer.
    stress
        Number of plants to look for one that breaks the block; None for none.

    Returns
    -------
    ObserverAnswer
    """
    inverses: dict[str, hyst.Operator | None] = {spec.inverse_name: spec.inverse, _NONE: None}
    if spec.hysteresis.is_invertible():
        inverses[hyst.control.EXACT] = spec.hysteresis.inverse()
    without: dict[str, TriedLoop] = {}
    observed: dict[str, TriedLoop] = {}
    with progress_bar("simulating the loop") as progress:
        for k, (name, inverse) in enumerate(inverses.items()):
            without[name] = _run(spec, _block(spec, None, inverse))
            observed[name] = (
                without[name]
                if design.observer is None
                else _run(spec, _block(spec, design, inverse))
            )
            progress((k + 1) / len(inverses))
    with at_work("certifying the block"):
        this = observed[spec.inverse_name]
        return hyst.report.ObserverAnswer(
            design=design,
            certificate=_certified(spec, this.block),
            inverse_name=spec.inverse_name,
            without=without,
            observed=observed,
            noise=spec.noise,
            rivals=_rivals(spec, design, without[spec.inverse_name].block),
            true_plant=_of_true_plant(spec, this),
            bound=_bound(spec, this),
            identified=_identified(spec),
            stress=None if stress is None else _stressed(spec, this.block, stress),
            margins=(
                _margins(spec, without[spec.inverse_name].block),
                _margins(spec, this.block),
            ),
            controller_design=spec.controller_design,
            parts=_parts(spec, design),
            unfit=any(_unfit(each) for each in (spec.hysteresis, spec.inverse)),
        )


def _unfit(operator: hyst.Operator | None) -> bool:
    verdict = None if operator is None else operator.description.verdict
    return verdict is not None and verdict.level == UNFIT


def _block(spec: ObserverSpec, design: Any, inverse: hyst.Operator | None) -> TrackingController:
    # What the limited drive makes of v: by the model where the inverse is that of the model.
    forward = spec.hysteresis if inverse == _exact(spec.hysteresis) else None
    return hyst.control.TrackingController.from_continuous(
        spec.controller,
        spec.filter_dt,
        observer=None if design is None else design.observer,
        inverse=inverse,
        method=spec.filter_method,
        limits=spec.limits,
        rate=spec.rate,
        hysteresis=None if spec.limits is None else forward,
        feedforward=spec.feedforward,
        plant=spec.plant,
        despite_verdict=True,  # who does not want that was refused at the beginning
    )


def _exact(hysteresis: hyst.Operator) -> hyst.Operator | None:
    return hysteresis.inverse() if hysteresis.is_invertible() else None


def _run(spec: ObserverSpec, block: TrackingController) -> TriedLoop:
    return hyst.control.try_block(
        block,
        spec.reference,
        plant=spec.plant,
        Wu=spec.Wu,
        hysteresis=spec.hysteresis,
        true_plant=spec.true_plant,
        noise=spec.noise,
        delay=spec.delay,
        disturbance=spec.disturbance,
        seed=spec.seed,
        settle=spec.settle,
        start=spec.start,
        slope_error=_slope_error(spec),
    )


def _slope_error(spec: ObserverSpec) -> float:
    """Three standard errors of the slope of an identified hysteresis, of itself; 0 if not told."""
    if spec.identified is None or spec.identified.errors is None:
        return 0.0
    return _STANDARD_ERRORS * (spec.identified.errors.slope_error or 0.0)


def _margins(spec: ObserverSpec, block: TrackingController) -> LoopMargins:
    return hyst.control.loop_margins(spec.plant, block, delay=spec.delay)


def _parts(spec: ObserverSpec, design: Any) -> LoopComparison | None:
    """Compare inverse, feedback and observer where there is a feedforward to compare with."""
    if spec.feedforward is None or spec.inverse is None:
        return None
    return hyst.control.compare_loops(
        spec.reference,
        spec.filter_dt,
        plant=spec.plant,
        controller=spec.controller,
        hysteresis=spec.hysteresis,
        inverse=spec.inverse,
        feedforward=spec.feedforward,
        observer=design.observer,
        Wu=spec.Wu,
        noise=spec.noise,
        method=spec.filter_method,
        despite_verdict=True,
        true_plant=spec.true_plant,
        delay=spec.delay,
        disturbance=spec.disturbance,
        seed=spec.seed,
        settle=spec.settle,
        start=spec.start,
        slope_error=_slope_error(spec),
        limits=spec.limits,
        rate=spec.rate,
    )


def _certified(spec: ObserverSpec, block: TrackingController) -> SampledCertificate:
    return hyst.control.sampled_certificate(block, spec.plant, spec.Wu, spec.Wp, delay=spec.delay)


def _rivals(
    spec: ObserverSpec, design: Any, alone: TrackingController
) -> dict[str, SampledCertificate]:
    """Certify the controller alone, and the block with the classical observer of this rate."""
    found = {} if design.observer is None else {_ALONE: _certified(spec, alone)}
    try:
        classical = hyst.control.design_sampled_q_filter(
            spec.plant, spec.controller, spec.Wu, spec.Wp, dt=spec.filter_dt, delay=spec.delay
        )
    except hyst.HystError as refused:
        note(f"no classical observer to compare with: {refused}")
        return found
    block = _block(spec, classical, spec.inverse)
    return found | {f"classical, {classical.name}": _certified(spec, block)}


def _stressed(spec: ObserverSpec, block: TrackingController, tries: int) -> hyst.control.StressTest:
    return hyst.control.stress(block, spec.plant, spec.Wu, tries, delay=spec.delay, seed=spec.seed)


def _of_true_plant(spec: ObserverSpec, this: TriedLoop) -> TruePlant | None:
    if spec.true_plant is None:
        return None
    used, at = hyst.control.uncertainty_used(spec.plant, spec.Wu, spec.true_plant)
    failing = hyst.control.sampled_slope_failing(
        this.block, spec.true_plant, this.judgement.met, delay=spec.delay
    )
    return hyst.report.TruePlant(
        poles=hyst.control.closed_loop_poles(spec.true_plant, this.block, delay=spec.delay),
        used=used,
        frequency=at,
        failing=failing,
    )


def _identified(spec: ObserverSpec) -> tuple[float, float] | None:
    """Give the drives that the model was identified from, where its file tells."""
    about = spec.hysteresis.description
    if about.input_low is None or about.input_high is None:
        return None
    return about.input_low, about.input_high


def _bound(spec: ObserverSpec, this: TriedLoop) -> ErrorBound | None:
    """Bound the error of the inverse over the range it was used in, where there is a bound."""
    if this.loop.diverged_at is not None:
        return None
    inverse = hyst.Affine(1.0) if spec.inverse is None else spec.inverse
    reach = float(abs(this.loop.v).max())
    # It is for plays between maps; other models have none.
    try:
        return hyst.compensation.error_bound(spec.hysteresis, inverse, reach)
    except (hyst.InputError, hyst.NotInvertibleError):
        return None
