"""What overflows inside an operator is refused by name, in every engine, and nothing is changed."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import InputError, LinearDynamics, Operator, PrandtlIshlinskii
from hyst.models import MemoryElement, MemoryFunction
from hyst.operators import Affine, DeadZone, Play, Stop
from hyst.operators.engine_name import EngineName
from hyst.operators.evaluation import explain, run_parameter_sets

ENGINES: list[EngineName] = ["auto", "loop", "lanes", "memory-curve"]

# All but the last two end in a finite number: a stop never gives more than its threshold, and the
# saturating map has slope 0 beyond 1.
OVERFLOWING: dict[str, Operator] = {
    "play": Play(1.0) @ Affine(1e10),
    "stop": Stop(1.0) @ Affine(1e10),
    "plays": PrandtlIshlinskii([1.0, 0.5], [0.1, 0.2], 1.0) @ Affine(1e10),
    "saturation": DeadZone([1.0, -1.0], [0.0, 1.0]) @ Affine(1e10),
    "stop after plays": Stop(1.0) @ PrandtlIshlinskii([1e10, 0.5], [0.1, 0.2], 1.0),
    "memory": MemoryElement(MemoryFunction.polynomial([1e10, 0.0, 1.0]), 1e-3),
    "affine": Affine(1e10),
    "dynamics": LinearDynamics([[0.5]], [[1.0]], [[1e10]], 0.0, 1e-3),
}

each_operator = pytest.mark.parametrize("operator", OVERFLOWING.values(), ids=list(OVERFLOWING))


def first_fault(operator: Operator, u: np.ndarray) -> int:
    """Give the sample at which the step for real time raises its flag."""
    step = operator.stepper()
    for k, value in enumerate(u.tolist()):
        step(value)
        if step.fault:
            return k
    raise AssertionError("the step raises no flag")


@each_operator
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("samples", [3, 70, 50_000])
def test_the_sample_the_stepper_holds_is_named(
    instruction_set: str, operator: Operator, engine: EngineName, samples: int
) -> None:
    u = np.sin(np.arange(samples) * 0.01)
    u[samples // 2] = -1e305
    first = first_fault(operator, u)
    assert samples // 2 <= first <= samples // 2 + 1
    for threads in (1, 2):
        state = operator.initial_state()
        before = state.copy()
        with pytest.raises(InputError, match=rf"u\[{first}\] = .* overflows") as refusal:
            operator.run(u, state, engine=engine, threads=threads)
        assert "\n" not in str(refusal.value)
        assert state.tobytes() == before.tobytes()


@each_operator
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("rows", [3, 21])
def test_a_batch_names_row_and_sample(
    instruction_set: str, operator: Operator, engine: EngineName, rows: int
) -> None:
    u = np.tile(np.sin(np.arange(300) * 0.1), (rows, 1))
    u[rows - 1, 255] = 1e305
    first = first_fault(operator, u[rows - 1])
    state = np.tile(operator.initial_state(), (rows, 1))
    before = state.copy()
    for threads in (1, 2):
        with pytest.raises(InputError, match=rf"u\[\({rows - 1}, {first}\)\] = .* overflows"):
            operator.run(u, state, engine=engine, threads=threads)
        assert state.tobytes() == before.tobytes()


def test_a_number_that_is_not_finite_is_named_before_one_that_overflows() -> None:
    with pytest.raises(InputError, match=r"u\[2\] is nan"):
        (Play(1.0) @ Affine(1e10)).run([1e305, 0.0, np.nan])


@pytest.mark.parametrize("engine", ENGINES)
def test_the_largest_numbers_that_fit_pass(engine: EngineName) -> None:
    # (u - r) + 2 r, as the memory curve has it, is beyond the doubles; every play is not.
    model = PrandtlIshlinskii([0.25, 0.25], [0.0, 1e308], p0=0.25)
    u = np.tile([1.7e308, -1.7e308], 300)
    y, _ = model.run(u, engine=engine)
    # Plays: 1.7e308, and 0.7e308 with the sign of u. 0.25 (1.7 + 1.7 + 0.7) = 1.025.
    np.testing.assert_allclose(y, np.sign(u) * 1.025e308, rtol=1e-15)


def test_what_is_built_on_evaluation_refuses_too() -> None:
    operator = Play(1.0) @ Affine(1e10)
    with pytest.raises(InputError, match=r"u\[1\] = 1e\+305 the operator overflows"):
        explain(operator, [0.0, 1e305])
    with pytest.raises(InputError, match=r"u\[1\] = 1e\+305 the operator overflows"):
        hyst.Affine(1e10).loss_gradient([0.0, 1e305], [0.0, 0.0])
    with pytest.raises(InputError, match="parameter set 1 overflows"):
        run_parameter_sets([1.0, 1e10], [[1.0], [1.0]], [[0.1], [0.1]], [0.0, 1e305])
