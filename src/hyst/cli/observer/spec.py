"""What ``hyst observer`` is asked for: the spec, read strictly."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst._files import read_small
from hyst.checks.numbers import as_not_negative, as_positive
from hyst.cli.arguments import load_operator
from hyst.cli.observer.controller import read_controller
from hyst.cli.observer.design import HowToDesign, read_design
from hyst.cli.observer.plant import (
    block_dt,
    load_hysteresis,
    read_hysteresis,
    read_plant,
    read_uncertainty,
)
from hyst.cli.observer.reference import read_reference, resting_output
from hyst.cli.spec_section import Section

if TYPE_CHECKING:
    from hyst.control import ControllerDesign, IdentifiedPlant, InternalModel, LinearSystem
    from hyst.control.discretization import Method
    from hyst.operators import Operator

Array = NDArray[np.float64]

_INVERSES = ("exact", "scaled", "reduced", "file", "none")


@dataclass(frozen=True, eq=False)
class ObserverSpec:
    """A loop, what is asked of its observer, and how to try it.

    ``plant``, ``true_plant`` (or None), ``controller``, weights ``Wu``, ``Wp`` and ``Wn`` (or
    None) and ``internal_model`` are what is designed with; ``hysteresis``, ``inverse`` (or None,
    named ``inverse_name``), ``reference``, at the samples of the block, ``settle``, ``noise``,
    ``disturbance`` and ``seed`` what is simulated; ``filter_dt``, ``filter_method`` and ``delay``
    say what is implemented; ``design`` how, ``limits`` and ``rate`` what its drive may do.
    ``controller_design`` is what C was designed by, or None, ``feedforward`` stands beside it, or
    is None, and ``start`` says how a loop starts. The plant is sampled where it was ``identified``
    (else None), continuous where it was written; ``delay`` is its dead time and that of the block
    together.
    """

    plant: LinearSystem
    true_plant: LinearSystem | None
    controller: LinearSystem
    controller_design: ControllerDesign | None
    feedforward: Any
    Wu: LinearSystem
    Wp: LinearSystem
    Wn: LinearSystem | None
    internal_model: InternalModel
    hysteresis: Operator
    inverse: Operator | None
    inverse_name: str
    reference: Array
    start: str
    settle: float
    noise: float
    disturbance: float
    seed: int
    filter_dt: float
    filter_method: Method
    delay: float
    design: HowToDesign
    limits: tuple[float, float] | None
    rate: float | None
    identified: IdentifiedPlant | None


def read_spec(path: Path) -> ObserverSpec:
    """Read a spec; every mistake is an InputError that names the entry."""
    try:
        text = read_small(path).decode("utf-8")
        spec = Section(tomllib.loads(text), "the spec")
    except FileNotFoundError:
        raise hyst.InputError(
            f"{path}: there is no such file; hyst observer --template > {path.name} makes one"
        ) from None
    except IsADirectoryError:
        raise hyst.InputError(f"{path} is a folder; name a spec") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise hyst.InputError(f"{path} is no TOML file: {error}") from None
    try:
        return _spec(spec, path.parent)
    except hyst.NotInvertibleError as error:
        raise hyst.NotInvertibleError(f"{path}: {error}") from None
    except hyst.InputError as error:
        raise hyst.InputError(f"{path}: {error}") from None


def _spec(spec: Section, folder: Path) -> ObserverSpec:
    weights = spec.section("weights")
    simulation = spec.section("simulation")
    implemented = spec.section("filter")
    plant = read_plant(spec.section("plant"), folder, implemented)
    hysteresis = read_hysteresis(spec, plant, folder)
    if hysteresis is None:
        hysteresis = _hysteresis(spec.section("hysteresis"), folder)
    filter_dt = block_dt(implemented, plant)
    # The sample time of a reference from a file; sines are taken at the block's samples.
    dt = simulation.number("dt", filter_dt, positive=True)
    begun = read_reference(
        spec.section("reference"), dt, folder, lambda: resting_output(hysteresis, plant.system)
    )
    reference = begun.samples
    inverse, name = _inverse(spec.section("inverse"), hysteresis, folder)
    settle = _settle(simulation, reference.size * dt, filter_dt)
    method = implemented.text("method", "tustin", get_args(hyst.control.discretization.Method))
    limits, rate = _limits(spec)
    Wu = read_uncertainty(weights, plant, folder)
    delay = plant.delay + _further_delay(implemented)
    controller = read_controller(
        spec.section("controller"), plant.system, Wu, filter_dt, delay, method
    )
    read = ObserverSpec(
        plant=plant.system,
        true_plant=_true_plant(spec, plant.system),
        controller=controller.system,
        controller_design=controller.design,
        feedforward=controller.feedforward,
        Wu=Wu,
        Wp=weights.section("Wp").system(),
        Wn=weights.section("Wn").system() if weights.has("Wn") else None,
        internal_model=_internal_model(spec.section("internal_model"), filter_dt),
        hysteresis=hysteresis,
        inverse=inverse,
        inverse_name=name,
        reference=_at_samples(reference, dt, filter_dt),
        start=begun.start,
        settle=settle,
        noise=as_not_negative(
            simulation.number("noise", 0.0), "[simulation] noise", "a standard deviation"
        ),
        disturbance=simulation.number("disturbance", 0.0),
        seed=simulation.count("seed", 0),
        filter_dt=filter_dt,
        filter_method="zoh" if method == "zoh" else "tustin",
        delay=delay,
        design=read_design(spec, plant.system.dt > 0.0),
        limits=limits,
        rate=rate,
        identified=plant.identified,
    )
    for each in (spec, weights, simulation, implemented):
        each.done()
    return read


def _true_plant(spec: Section, plant: LinearSystem) -> LinearSystem | None:
    """Read ``[true_plant]``, which may be left out; it comes as late as the nominal one."""
    if not spec.has("true_plant"):
        return None
    read = spec.section("true_plant").system()
    if plant.dt > 0.0:
        raise hyst.InputError(
            "[true_plant] is continuous, and [plant] is known at its samples; leave it out, or, of "
            'a model file, give [plant] form = "continuous"'
        )
    if read.order and read.poles().real.max() >= 0.0:
        worst = complex(read.poles()[np.argmax(read.poles().real)])
        raise hyst.InputError(
            f"[true_plant] is not stable, pole at {worst:.4g} 1/s; give the stable plant that the "
            "loop meets"
        )
    return read


def _settle(simulation: Section, duration: float, filter_dt: float) -> float:
    """Read the seconds that errors leave out: some must be left to measure."""
    settle = simulation.number("settle", 0.0)
    if not 0.0 <= settle < duration:
        raise hyst.InputError(
            f"[simulation] settle is {settle:g} s of {duration:g} s; leave some to measure"
        )
    if filter_dt >= duration - settle:
        raise hyst.InputError(
            f"[filter] dt is {filter_dt:g} s, and {duration - settle:g} s are measured; "
            "give a shorter one"
        )
    return settle


def _further_delay(implemented: Section) -> float:
    return as_not_negative(implemented.number("delay", 0.0), "[filter] delay", "a time in s")


def _limits(spec: Section) -> tuple[tuple[float, float] | None, float | None]:
    """Read ``[limits]``, which may be left out: ``drive = [low, high]`` and ``rate``, units a s."""
    if not spec.has("limits"):
        return None, None
    given = spec.section("limits")
    drive = None
    if given.has("drive"):
        values = given.numbers("drive")
        if values.size != 2 or values[0] >= values[1]:
            raise hyst.InputError(
                f"[limits] drive is {values.tolist()}; give [low, high], the lower one first"
            )
        drive = (float(values[0]), float(values[1]))
    rate = given.number("rate", positive=True) if given.has("rate") else None
    given.done()
    return drive, rate


def _internal_model(given: Section, dt: float) -> InternalModel:
    sinusoids = given.numbers("sinusoids", ())
    if given.has("A") or given.has("C"):
        model = hyst.control.InternalModel(given.matrix("A"), given.matrix("C"))
    else:
        kind = given.text("kind", choices=("integrator", "ramp"))
        model = (
            hyst.control.InternalModel.integrator()
            if kind == "integrator"
            else hyst.control.InternalModel.ramp()
        )
    given.done()
    for frequency in sinusoids:
        as_positive(frequency, "[internal_model] sinusoids", "frequencies in Hz")
        if frequency * dt >= 0.5:
            raise hyst.InputError(
                f"[internal_model] sinusoids has {frequency:g} Hz, and half the sample rate of "
                f"the block is {0.5 / dt:g} Hz: what it cannot see it cannot reject; leave it out"
            )
        model = model + hyst.control.InternalModel.sinusoid(2.0 * np.pi * float(frequency))
    return model


def _hysteresis(given: Section, folder: Path) -> Operator:
    if given.has("file"):
        path = given.text("file")
        given.done()
        return load_hysteresis(folder / path)
    p, r, p0 = given.numbers("p"), given.numbers("r"), given.number("p0")
    plays = hyst.PrandtlIshlinskii(p, r, p0)
    if not given.has("envelope"):
        given.done()
        return plays
    envelope = given.section("envelope")
    weights, thresholds = envelope.numbers("weights"), envelope.numbers("thresholds")
    envelope.done()
    given.done()
    return hyst.GeneralizedPrandtlIshlinskii(hyst.DeadZone.odd(weights, thresholds), plays)


def _inverse(given: Section, hysteresis: Operator, folder: Path) -> tuple[Operator | None, str]:
    kind = given.text("kind", choices=_INVERSES)
    inverse: Operator | None = None
    name = kind
    if kind == "exact":
        inverse = hysteresis.inverse()
    elif kind == "scaled":
        factor = given.number("factor", positive=True)
        inverse, name = hyst.Affine(factor) @ hysteresis.inverse(), f"{factor:g} of the exact"
    elif kind == "reduced":
        plays, reach = given.count("plays"), given.number("reach", positive=True)
        inverse, name = (
            hyst.compensation.reduce_inverse(hysteresis, plays, reach),
            f"{plays} play{'s' * (plays != 1)}",
        )
    elif kind == "file":
        path = given.text("file")
        inverse, name = load_operator(folder / path), path
    given.done()
    return inverse, name


def _at_samples(reference: Array, dt: float, filter_dt: float) -> Array:
    if dt == filter_dt:
        return reference
    end = (reference.size - 1) * dt
    at = np.arange(0.0, end + 0.5 * filter_dt, filter_dt)
    return np.asarray(np.interp(at, np.arange(reference.size) * dt, reference))
