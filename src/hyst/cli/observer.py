"""hyst observer: design a disturbance observer, try it, and say what to implement."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

import hyst
from hyst._files import replacing_files, require_folder
from hyst.cli.arguments import DespiteVerdict
from hyst.cli.console import at_work, note, progress_bar, show_files, show_table
from hyst.cli.observer_spec import read_spec
from hyst.cli.observer_template import TEMPLATE
from hyst.operators.verdict import refuse_if_unfit

if TYPE_CHECKING:
    from hyst.cli.observer_spec import ObserverSpec
    from hyst.compensation import ErrorBound
    from hyst.control import DisturbanceObserver, InverseComparison
    from hyst.report import ObserverAnswer

SpecFile = Annotated[
    Path | None, typer.Argument(metavar="SPEC.toml", show_default=False, help="What to design.")
]
Folder = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write."),
]
Template = Annotated[
    bool, typer.Option("--template", help="Print a spec to start from, and do nothing else.")
]

NONE = "none"


def observer(
    spec_file: SpecFile = None,
    folder: Folder = None,
    template: Template = False,
    despite_verdict: DespiteVerdict = False,
) -> None:
    """Design a disturbance observer; say if the loop is safe, and write what to implement."""
    if template:
        if spec_file is not None or folder is not None:
            raise hyst.InputError("--template prints a spec and takes nothing else; leave out rest")
        print(TEMPLATE, end="")
        return
    if spec_file is None or folder is None:
        raise hyst.InputError(
            "give a spec and -o DIR; hyst observer --template > spec.toml makes a spec"
        )
    require_folder(folder)
    spec = read_spec(spec_file)
    for each in (spec.hysteresis, spec.inverse):
        judged = None if each is None else each.description.verdict
        refuse_if_unfit(judged, "no controller is designed", despite_verdict)
    design = _design(spec)
    answer = _tried(spec, design)
    with at_work("drawing"):
        bode = hyst.report.draw_observer_bode(
            hyst.control.loop_responses(design, spec.true_plant), "Disturbance observer"
        )
        loops = hyst.report.draw_closed_loops(
            _shown(answer), "Closed loop with the true hysteresis"
        )
        page = answer.to_html(bode, loops)
    names = ["certificate.json", "report.html", "bode.png", "closed_loop.png", "signals.csv"]
    with replacing_files(folder) as temporary:
        text = json.dumps(answer.to_dict(), indent=2, allow_nan=False)
        (temporary / names[0]).write_text(text + "\n", encoding="utf-8")
        (temporary / names[1]).write_text(page, encoding="utf-8")
        (temporary / names[2]).write_bytes(bode)
        (temporary / names[3]).write_bytes(loops)
        _write_signals(temporary / names[4], answer)
        if answer.safe:
            names.append("controller.json")
            answer.block.save(temporary / names[5])
    _tell(answer)
    lag = hyst.report.delay_to_act_on(spec.hysteresis.description)
    if lag:
        note(f"the recorded output lagged the model by {lag}: put that lag into plant or Wu")
    show_files([folder / name for name in names])


def _design(spec: ObserverSpec) -> DisturbanceObserver:
    try:
        return _designed(spec, "slpmm+descent")
    except hyst.MissingExtraError as missing:
        note(f"{missing}; the descent alone is used, which needs neither")
        return _designed(spec, "descent")


def _designed(spec: ObserverSpec, method: str) -> DisturbanceObserver:
    with at_work("designing the observer") as say:
        return hyst.control.design_disturbance_observer(
            spec.plant,
            spec.controller,
            spec.Wu,
            spec.Wp,
            spec.internal_model,
            perturbed_plant=spec.true_plant,
            method=method,
            progress=lambda stage, step, best: say(f"{stage} {step}, best norm {best:.4f}"),
        )


def _tried(spec: ObserverSpec, design: DisturbanceObserver) -> ObserverAnswer:
    inverses: dict[str, hyst.Operator | None] = {spec.inverse_name: spec.inverse, NONE: None}
    if spec.hysteresis.is_invertible():
        inverses[hyst.control.EXACT] = spec.hysteresis.inverse()
    plant = spec.plant if spec.true_plant is None else spec.true_plant
    with progress_bar("simulating the loop") as progress:
        comparison = hyst.control.compare_inverses(
            spec.reference,
            spec.dt,
            inverses,
            observer=design,
            progress=progress,
            plant=plant,
            controller=spec.controller,
            hysteresis=spec.hysteresis,
            noise=spec.noise,
            disturbance=spec.disturbance,
            seed=spec.seed,
            settle=spec.settle,
        )
    block = hyst.control.TrackingController.from_continuous(
        spec.controller,
        spec.filter_dt,
        observer=design,
        inverse=spec.inverse,
        method=spec.filter_method,
        despite_verdict=True,  # who does not want that was refused at the beginning
    )
    bound, slopes = _of_inverse(spec, comparison)
    margin = None
    if slopes is not None:
        margin = hyst.control.slope_margin(plant, spec.controller, design, slopes)
    seen = _slopes_seen(comparison.observed[spec.inverse_name])
    return hyst.report.ObserverAnswer(
        design=design,
        comparison=comparison,
        inverse_name=spec.inverse_name,
        block=block,
        sampled=_sampled(spec, plant, block),
        sampled_poles=hyst.control.closed_loop_poles(plant, block),
        bound=bound,
        slopes=slopes,
        slope_margin=margin,
        seen_slopes=seen,
        unstable_slope=hyst.control.first_unstable_slope(plant, spec.controller, design, seen),
        identified=_identified(spec),
        uncertainty_used=hyst.control.uncertainty_used(design, plant) if spec.true_plant else None,
    )


def _sampled(
    spec: ObserverSpec, plant: hyst.control.LinearSystem, block: hyst.control.TrackingController
) -> hyst.control.ClosedLoop:
    """Simulate the loop as the target runs it, at the sample time of the filter."""
    end = (spec.reference.size - 1) * spec.dt
    at = np.arange(0.0, end + 0.5 * spec.filter_dt, spec.filter_dt)
    return hyst.control.simulate_closed_loop(
        np.interp(at, np.arange(spec.reference.size) * spec.dt, spec.reference),
        spec.filter_dt,
        plant=plant,
        controller=block,
        hysteresis=spec.hysteresis,
        noise=spec.noise,
        disturbance=spec.disturbance,
        seed=spec.seed,
        settle=spec.settle,
    )


def _identified(spec: ObserverSpec) -> tuple[float, float] | None:
    """Give the drives that the model was identified from, where its file tells."""
    about = spec.hysteresis.description
    if about.input_low is None or about.input_high is None:
        return None
    return about.input_low, about.input_high


def _slopes_seen(loop: hyst.control.ClosedLoop) -> tuple[float, float]:
    """Least and largest slope of hysteresis after inverse while v moved; 1 and 1 if it did not."""
    step = np.diff(loop.v)
    # Where v nearly rests, at a turn, a quotient of differences is rounding.
    moving = np.abs(step) > 1e-3 * np.abs(step).max(initial=0.0)
    if not moving.any():
        return 1.0, 1.0
    slopes = np.diff(loop.eta)[moving] / step[moving]
    return float(slopes.min()), float(slopes.max())


def _of_inverse(
    spec: ObserverSpec, comparison: InverseComparison
) -> tuple[ErrorBound | None, tuple[float, float] | None]:
    """Bound and slopes of the inverse over the range it was used in, where there are any."""
    loop = comparison.observed[spec.inverse_name]
    if loop.diverged_at is not None:
        return None, None
    inverse = hyst.Affine(1.0) if spec.inverse is None else spec.inverse
    reach = float(np.abs(loop.v).max())
    # Both are for plays between maps; other models have none.
    try:
        slopes = hyst.compensation.slope_range(spec.hysteresis, inverse, reach)
    except hyst.InputError:
        return None, None
    try:
        return hyst.compensation.error_bound(spec.hysteresis, inverse, reach), slopes
    except hyst.NotInvertibleError:
        return None, slopes


def _shown(answer: ObserverAnswer) -> dict[str, hyst.control.ClosedLoop]:
    name, found = answer.inverse_name, answer.comparison
    loops = {f"{name}, without": found.without[name], f"{name}, observer": found.observed[name]}
    if hyst.control.EXACT in found.without and name != hyst.control.EXACT:
        loops["exact, without"] = found.without[hyst.control.EXACT]
    return loops


def _write_signals(path: Path, answer: ObserverAnswer) -> None:
    loop = answer.sampled
    columns = [loop.t, loop.r, loop.y, loop.u, loop.eta, loop.d_hat]
    hyst.io.write_columns(path, ["time [s]", "y_ref", "y", "u", "w", "d_hat"], columns)


def _tell(answer: ObserverAnswer) -> None:
    print(answer.verdict())
    print(answer.gain_sentence())
    print(f"To implement: {answer.implement_sentence()}")
    for table in answer.tables():
        show_table(table)
