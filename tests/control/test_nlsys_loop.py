"""The loop as a system of python-control has the bits of ``simulate_closed_loop``."""

from __future__ import annotations

from typing import Any

import closed_loop_cases as s1
import numpy as np
import pytest

import control
import hyst
from hyst import InputError
from hyst.control import (
    TrackingController,
    as_linear_system,
    closed_loop_system,
    discretize,
    simulate_closed_loop,
    to_nlsys,
)

DT, SAMPLES = 5e-4, 250
INEXACT = hyst.Affine(0.7) @ s1.INVERSE
LATE = hyst.LinearDynamics([], [], [], 1.0, DT, delay=2)
RANDOM = np.random.default_rng(3)
NOISE, DISTURBANCE = RANDOM.normal(size=(2, SAMPLES)) * [[0.05], [0.3]]
REFERENCE = 18.0 + s1.reference(SAMPLES * DT, DT)


def block_of(observer: Any = None, inverse: Any = INEXACT, dt: float = DT) -> TrackingController:
    return TrackingController.from_continuous(s1.CONTROLLER, dt, observer=observer, inverse=inverse)


def outputs_of(loop: control.InterconnectedSystem, *inputs: Any) -> dict[str, np.ndarray]:
    response = control.input_output_response(loop, loop.dt * np.arange(len(inputs[0])), [*inputs])
    return dict(zip(loop.output_labels, np.asarray(response.outputs), strict=True))


CASES: dict[str, dict[str, Any]] = {
    "bare": {},
    "with the observer": {"block": block_of(s1.printed_observer())},
    "without an inverse": {
        "block": block_of(s1.printed_observer(), None),
        "hysteresis": hyst.PrandtlIshlinskii([0.3], [1.0], 0.5),
    },
    "without a hysteresis": {"hysteresis": None},
    "with a delay": {"hysteresis": s1.HYSTERESIS @ LATE},
    "with a hysteresis that begins elsewhere": {
        "hysteresis": hyst.PrandtlIshlinskii([0.5, 0.3], [1.0, 3.0], 0.2, z0=[0.5, -1.25]),
    },
    "disturbed at the plant": {"disturbance_at": "plant"},
    "with a sampled plant": {"plant": discretize(s1.PLANT, DT, "zoh")},
    "with a plant of LinearDynamics": {
        "plant": hyst.LinearDynamics.from_continuous(*s1.mode(*s1.MODES[0]), DT, delay=1.4)
    },
    "with a plant of python-control": {"plant": control.tf(*s1.mode(*s1.MODES[0]))},
    "with a plant that answers at once": {"plant": ([1.0, 2000.0], [1.0, 4000.0])},
    "with a delay of computation": {"delay": 1.6 * DT},
    "with a plant that is a gain": {"plant": 0.2},
    "with a limited drive": {
        "block": TrackingController.from_continuous(
            s1.CONTROLLER,
            DT,
            observer=s1.printed_observer(),
            inverse=INEXACT,
            limits=(3.0, 20.0),
            rate=1e5,
        )
    },
}


@pytest.mark.parametrize("case", CASES)
def test_the_loop_has_the_bits_of_the_simulation(case: str) -> None:
    given = {"plant": s1.PLANT, "hysteresis": s1.HYSTERESIS, "block": block_of()} | CASES[case]
    block = given.pop("block")
    there = outputs_of(closed_loop_system(block, **given), REFERENCE, NOISE, DISTURBANCE)
    here = simulate_closed_loop(
        REFERENCE, DT, controller=block, noise=NOISE, disturbance=DISTURBANCE, **given
    )
    assert here.diverged_at is None
    assert np.ptp(here.y) > 1.0
    for name in ("y", "u", "v", "eta", "d_hat"):
        # Adding zero takes the sign from zeros, which python-control's sums do not keep.
        assert (there[name] + 0.0).tobytes() == (getattr(here, name) + 0.0).tobytes(), name


@pytest.mark.parametrize("seed", range(6))
def test_so_has_a_loop_at_random(seed: int) -> None:
    """Any dt, plant, controller and hysteresis; slow enough to be stable."""
    draw = np.random.default_rng(seed)
    dt = 10.0 ** draw.uniform(-5.0, 0.0)
    poles = -draw.uniform(0.05, 1.0, 1 + seed % 4) / dt
    plant = [float(np.prod(-poles))], np.poly(poles)
    p, r = draw.uniform(0.0, 0.4, 3), np.sort(draw.uniform(0.1, 3.0, 3))
    stage = hyst.PrandtlIshlinskii(p, r, 0.5, z0=np.clip(draw.normal(), -r, r))
    controller = ([draw.uniform(0.0, 0.1), 0.02 / dt], [1.0, 0.0])
    block = TrackingController.from_continuous(controller, dt, inverse=stage.inverse())
    signals = np.cumsum(draw.normal(size=60)), 0.1 * draw.normal(size=60), draw.normal(size=60)
    place = ("hysteresis", "plant")[seed % 2]
    loop = closed_loop_system(block, plant=plant, hysteresis=stage, disturbance_at=place)
    there = outputs_of(loop, *signals)
    here = simulate_closed_loop(
        signals[0],
        dt,
        plant=plant,
        controller=block,
        hysteresis=stage,
        noise=signals[1],
        disturbance=signals[2],
        disturbance_at=place,
    )
    assert here.diverged_at is None
    assert (there["y"] + 0.0).tobytes() == (here.y + 0.0).tobytes()
    assert (there["u"] + 0.0).tobytes() == (here.u + 0.0).tobytes()


@pytest.mark.parametrize("observer", [None, s1.printed_observer()], ids=["bare", "observer"])
@pytest.mark.parametrize("limits", [(-20.0, 20.0), (2.0, 20.0)], ids=["about zero", "above zero"])
def test_so_has_a_loop_with_a_limited_drive(observer: Any, limits: tuple[float, float]) -> None:
    block = TrackingController.from_continuous(
        s1.CONTROLLER, DT, observer=observer, inverse=s1.INVERSE, limits=limits, rate=3000.0
    )
    loop = closed_loop_system(block, plant=s1.PLANT, hysteresis=s1.HYSTERESIS)
    there = outputs_of(loop, 2.0 * REFERENCE, NOISE, DISTURBANCE)
    here = simulate_closed_loop(
        2.0 * REFERENCE,
        DT,
        plant=s1.PLANT,
        controller=block,
        hysteresis=s1.HYSTERESIS,
        noise=NOISE,
        disturbance=DISTURBANCE,
    )
    assert here.u.max() == limits[1]
    for name in ("y", "u", "v", "eta"):
        assert (there[name] + 0.0).tobytes() == (getattr(here, name) + 0.0).tobytes(), name
    # The estimate of a record is summed in another order than that of a sample.
    assert np.abs(there["d_hat"] - here.d_hat).max() < 1e-9


def test_a_loop_that_the_user_joins_by_names_is_the_same_to_rounding() -> None:
    block = block_of(s1.printed_observer())
    sampled = control.c2d(as_linear_system(s1.PLANT).as_control(), DT, "zoh")
    plant = control.ss(sampled, inputs="eta", outputs="y", name="plant")
    parts = [to_nlsys(block), to_nlsys(s1.HYSTERESIS, outputs="eta"), plant]
    loop = control.interconnect(parts, inputs="y_ref", outputs=["y", "u"])
    there = outputs_of(loop, REFERENCE)
    here = simulate_closed_loop(
        REFERENCE, DT, plant=s1.PLANT, controller=block, hysteresis=s1.HYSTERESIS
    )
    # python-control samples the plant and sums its states in its own way: rounding of signals up to
    # 60, which the loop, being stable, does not let grow.
    assert np.abs(there["y"] - here.y).max() < 1e-10
    assert np.abs(there["u"] - here.u).max() < 1e-10


def rate_limited(step: float) -> Any:
    """An actuator of the user's own, in front of the hysteresis."""

    def follow(t: float, x: np.ndarray, u: np.ndarray, params: Any) -> np.ndarray:
        return np.clip(u, x - step, x + step)

    return control.nlsys(follow, follow, inputs=1, outputs=1, states=1, dt=DT, name="amplifier")


def test_parts_of_the_users_own_take_the_places_of_ours() -> None:
    """Against the same loop written out by hand, sample by sample."""
    block = block_of(s1.printed_observer())
    held = discretize(s1.mode(*s1.MODES[0]), DT, "zoh")
    softening = control.nlsys(
        lambda t, x, w, params: held.A @ x + held.B[:, 0] * np.tanh(w[0] / 50.0) * 50.0,
        lambda t, x, w, params: held.C @ x,
        inputs=1,
        outputs=1,
        states=2,
        dt=DT,
    )
    amplifier, step = rate_limited(0.2), block.stepper()
    there = outputs_of(
        closed_loop_system(block, plant=softening, hysteresis=amplifier), REFERENCE, 0.0, 0.0
    )
    x, drive, y = np.zeros(2), 0.0, np.zeros(SAMPLES)
    for k in range(SAMPLES):
        y[k] = (held.C @ x)[0]
        drive = float(np.clip(step(REFERENCE[k], y[k]), drive - 0.2, drive + 0.2))
        x = held.A @ x + held.B[:, 0] * np.tanh(drive / 50.0) * 50.0
    assert np.ptp(y) > 1.0
    assert there["y"].tolist() == y.tolist()


def test_a_block_of_the_users_own_takes_the_place_of_ours() -> None:
    integral = control.nlsys(
        lambda t, x, y, params: x + 5.0 * DT * (y[0] - y[1]),
        lambda t, x, y, params: [x[0], y[0] - y[1]],
        inputs=["wish", "measured"],
        outputs=["drive", "error"],
        states=1,
        name="integral",
    )
    integral.dt = DT
    loop = closed_loop_system(integral, plant=s1.PLANT, hysteresis=s1.HYSTERESIS)
    there = outputs_of(loop, REFERENCE, NOISE, 0.0)
    ours = TrackingController([[1.0]], [[5.0 * DT, -5.0 * DT]], [1.0], [0.0, 0.0], DT)
    here = simulate_closed_loop(
        REFERENCE, DT, plant=s1.PLANT, controller=ours, hysteresis=s1.HYSTERESIS, noise=NOISE
    )
    assert loop.output_labels == ["y", "eta", "u", "error"]
    # Sums in another order.
    assert np.abs(there["u"] - here.u).max() < 1e-12
    assert np.abs(there["error"] - (here.r - here.y_measured)).max() < 1e-12


def test_a_plant_of_the_users_own_that_answers_at_once_closes_an_algebraic_loop() -> None:
    gain = control.nlsys(None, lambda t, x, w, params: 0.2 * w, inputs=1, outputs=1, dt=DT)
    loop = closed_loop_system(block_of(), plant=gain)
    with pytest.raises(RuntimeError, match="algebraic loop"):
        outputs_of(loop, REFERENCE, 0.0, 0.0)


def test_a_loop_that_diverges_says_when() -> None:
    block = TrackingController.from_continuous(s1.PRINTED_CONTROLLER, DT, inverse=INEXACT)
    loop = closed_loop_system(block, plant=([2e6, 0.0], [1.0, 1e3]))
    with pytest.raises(InputError, match=r" at \d.*(diverges|overflows)"):
        outputs_of(loop, np.ones(600), 0.0, 0.0)


PLAIN = hyst.LinearDynamics([], [], [], 1.0, 2.0 * DT)
CONTINUOUS = control.ss([[-1.0]], [[1.0, -1.0]], [[1.0]], [[0.0, 0.0]])
REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "another dt": ({"dt": 2.0 * DT}, "dt is 0.001 s, that of the block 0.0005 s"),
    "a continuous block": ({"block": CONTINUOUS}, "the block is continuous; sample it"),
    "a block of one input": (
        {"block": control.tf([1.0], [1.0, 0.5], DT)},
        "the block has 1 inputs and 1 outputs; give a system from y_ref and y to u",
    ),
    "no block": ({"block": ([4.0], [1.0])}, "the block is tuple; give what hyst has for it"),
    "a block without a sample time": (
        {"block": control.ss([[0.5]], [[1.0, -1.0]], [[1.0]], [[0.0, 0.0]], True)},
        "the block has no sample time; give dt",
    ),
    "a plant without a sample time": (
        {"plant": control.tf([1.0], [1.0, 0.5], True)},
        "the plant is sampled with no sample time given",
    ),
    "a plant of another dt": (
        {"plant": control.tf([1.0], [1.0, 0.5], 2.0 * DT)},
        "the plant has dt = 0.001 s, the loop 0.0005 s",
    ),
    "an unstable plant": ({"plant": ([1.0], [1.0, -1.0])}, "the plant is unstable"),
    "a nonlinear plant in continuous time": (
        {"plant": control.nlsys(lambda t, x, u, p: u - x**3, None, inputs=1, states=1, dt=0)},
        "the plant is continuous; make it with dt = 0.0005 s",
    ),
    "a nonlinear plant of another dt": (
        {"plant": control.nlsys(lambda t, x, u, p: u, None, inputs=1, states=1, dt=2.0 * DT)},
        "the plant has dt = 0.001 s, the loop 0.0005 s",
    ),
    "a delay before a nonlinear plant": (
        {
            "plant": control.nlsys(lambda t, x, u, p: u, None, inputs=1, states=1, dt=DT),
            "delay": DT,
        },
        "cannot be put into a plant of your own",
    ),
    "a hysteresis of another dt": ({"hysteresis": PLAIN}, "dt = 0.0005 s, the model 0.001 s"),
    "no hysteresis": ({"hysteresis": 3.0}, "the hysteresis is float; give what hyst has for it"),
    "another place": ({"disturbance_at": "y"}, "give one of hysteresis, plant"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_parts_that_do_not_fit_are_refused(case: str) -> None:
    changed, words = REFUSED[case]
    given = {"block": block_of(), "plant": s1.PLANT} | changed
    with pytest.raises(InputError, match=words):
        closed_loop_system(given.pop("block"), **given)
