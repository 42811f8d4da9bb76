"""The plant of a spec, what is not known of it, and the hysteresis that comes with it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import hyst
from hyst.checks.numbers import as_not_negative, said
from hyst.cli.arguments import load_operator
from hyst.cli.console import note
from hyst.cli.spec_section import Section

if TYPE_CHECKING:
    from hyst.control import IdentifiedPlant, LinearSystem
    from hyst.operators import Operator

_IDENTIFICATION = "identification"
_FORMS = ("sampled", "continuous")


@dataclass(frozen=True, eq=False)
class SpecPlant:
    """The plant of a spec.

    Parameters
    ----------
    system
        Sampled, its whole delay among its states, if it was identified; else continuous.
    delay
        Dead time beside a continuous one, s.
    identified
        What it was taken from; None of a plant that was written.
    """

    system: LinearSystem
    delay: float
    identified: IdentifiedPlant | None

    @property
    def dt(self) -> float | None:
        """Sample time of the records it was identified from, s; None of one that was written."""
        return None if self.identified is None else self.identified.dt


def read_plant(given: Section, folder: Path, implemented: Section) -> SpecPlant:
    """Read ``[plant]``: a system with ``delay``; ``file``, a model; or ``response``, measured.

    Parameters
    ----------
    given
        The section.
    folder
        From which paths count.
    implemented
        The section ``[filter]``, whose dt is that of a plant fitted to a response.
    """
    if given.has("response"):
        return _from_response(given, folder, implemented)
    late = as_not_negative(given.number("delay", 0.0), "[plant] delay", "a dead time in seconds")
    if not given.has("file"):
        return SpecPlant(given.system(), late, None)
    found = hyst.control.identified_plant(folder / given.text("file"))
    form = given.text("form", "sampled", _FORMS)
    given.done()
    plant = found.dynamics if form == "sampled" else found.continuous_plant()
    system, delay = hyst.control.plant_and_delay(plant, late, "[plant]")
    return SpecPlant(system, delay, found)


def _from_response(given: Section, folder: Path, implemented: Section) -> SpecPlant:
    """Fit the plant to a frequency response; behind a hysteresis in units of y its gain is 1."""
    response = hyst.read_frequency_response(folder / given.text("response"))
    gain = given.number("gain", 1.0)
    given.done()
    found = hyst.control.measured_plant(response, implemented.number("dt", positive=True), gain)
    note(
        f"the plant is of order {found.dynamics.order}, {found.dynamics.delay} samples late, and "
        f"leaves {100.0 * found.error:.2g} % of the response; its gain at rest, "
        f"{found.measured_gain:.4g} as measured, is {gain:g}"
    )
    return SpecPlant(found.system, 0.0, None)


def read_hysteresis(spec: Section, plant: SpecPlant, folder: Path) -> Operator | None:
    """Give the hysteresis of a model file, which names it under ``[plant]``, if there is one.

    Parameters
    ----------
    spec
        All of the spec.
    plant
        As ``read_plant`` gives it.
    folder
        From which paths count.

    Returns
    -------
    Operator or None
        None where the hysteresis is written in a section of its own.
    """
    if plant.identified is None:
        return None
    if spec.has("hysteresis"):
        given = spec.section("hysteresis")
        path = given.text("file") if given.has("file") else None
        if path is None or (folder / path).resolve() != Path(plant.identified.name).resolve():
            raise hyst.InputError(
                "[plant] file holds the hysteresis in front of its plant, whose gain belongs to "
                "it; leave [hysteresis] out, or name the same file"
            )
        given.done()
    return plant.identified.hysteresis


def load_hysteresis(path: Path) -> Operator:
    """Read a model file that holds hysteresis alone.

    Raises
    ------
    InputError
        If it holds dynamics behind it as well: those are the plant.
    """
    found = load_operator(path)
    if hyst.control.has_dynamics_behind(found):
        raise hyst.InputError(
            f"{path} holds hysteresis and dynamics: name it under [plant], as file, and leave "
            "[hysteresis] out"
        )
    return found


def block_dt(implemented: Section, plant: SpecPlant) -> float:
    """Give the sample time of the block, by default that of an identified plant.

    Parameters
    ----------
    implemented
        The section ``[filter]``.
    plant
        As ``read_plant`` gives it.

    Raises
    ------
    InputError
        If it is not that of the identified plant, or there is neither.
    """
    dt = implemented.number("dt", plant.dt, positive=True)
    if plant.identified is not None and abs(dt - plant.identified.dt) > 1e-6 * dt:
        raise hyst.InputError(
            f"[filter] dt is {dt:.6g} s, and the plant of {plant.identified.name} was identified "
            f"at {plant.identified.dt:.6g} s; leave [filter] dt out, or record at {dt:.6g} s"
        )
    return plant.identified.dt if plant.identified is not None else dt


def read_uncertainty(weights: Section, plant: SpecPlant, folder: Path) -> LinearSystem:
    """Read ``Wu``: a system, ``"identification"``, or ``{ responses = [...] }``.

    Parameters
    ----------
    weights
        The section ``[weights]``.
    plant
        As ``read_plant`` gives it.
    folder
        From which paths count.

    Raises
    ------
    InputError
        If it is something else, or claims more than the identification of the plant can know.
    """
    value = weights.whole("Wu")
    if isinstance(value, str):
        return _from_identification(value, plant)
    given = weights.section("Wu")
    if given.has("responses"):
        return _from_responses(given, plant, folder)
    Wu = given.system()
    if plant.identified is not None:
        hyst.control.require_no_less_than_known(Wu, plant.identified)
    return Wu


def _from_identification(value: str, plant: SpecPlant) -> LinearSystem:
    if value != _IDENTIFICATION:
        raise hyst.InputError(
            f'[weights] Wu is {said(value)}; give a system, "{_IDENTIFICATION}", or '
            '{ responses = ["a.csv"] }'
        )
    if plant.identified is None:
        raise hyst.InputError(
            f'[weights] Wu is "{_IDENTIFICATION}", and the plant is written; name a model file '
            "under [plant], or give Wu"
        )
    continuous = plant.system.dt == 0.0
    return hyst.control.identification_weight(plant.identified, continuous=continuous).system


def _from_responses(given: Section, plant: SpecPlant, folder: Path) -> LinearSystem:
    paths = given.whole("responses")
    if not isinstance(paths, list) or not paths or not all(isinstance(p, str) for p in paths):
        raise hyst.InputError(
            f"[weights] Wu responses is {said(paths)}; give files of frequency responses, as "
            '["a.csv", "b.csv"]'
        )
    order = given.count("order") if given.has("order") else None
    least = given.number("least", 0.01, positive=True)
    matched = given.number("matched_at", positive=True) if given.has("matched_at") else None
    given.done()
    measured = [_without_delay(folder / each, plant.delay) for each in paths]
    return hyst.control.uncertainty_weight(
        plant.system,
        measured,
        order,
        least=least,
        matched_at=matched,
        identified=plant.identified,
    ).system


def _without_delay(path: Path, delay: float) -> Any:
    """Read a response, and turn it forward by the dead time that stands beside the plant."""
    found = hyst.read_frequency_response(path)
    w = 2.0 * np.pi * found.frequency
    return w, found.response * np.exp(1j * w * delay)
