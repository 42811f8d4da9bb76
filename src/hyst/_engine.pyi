"""Types of the compiled engine."""

from collections.abc import Iterable, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from hyst.operators.stage import Stage

Array = NDArray[np.float64]

class Chain:
    def __init__(self, stages: Iterable[Stage]) -> None: ...
    def __len__(self) -> int: ...
    def set_parameters(self, values: Array) -> None: ...
    def constants(self, i: int) -> dict[str, Any]: ...
    @property
    def state_length(self) -> int: ...
    @property
    def parameter_count(self) -> int: ...
    def run(
        self, state: Array, u: Array, y: Array, engine: str = "auto", threads: int = 1
    ) -> int: ...
    def explain(
        self, state: Array, u: Array, y: Array, engine: str = "auto"
    ) -> tuple[int, list[tuple[str, str, float, float, float, float]]]: ...
    def loss_gradient(
        self,
        state: Array,
        u: Array,
        target: Array,
        gradient: Array,
        engine: str = "auto",
        threads: int = 1,
    ) -> float: ...
    def jacobian(self, state: Array, u: Array, result: Array, derivative: str = "auto") -> None: ...
    def reverse(self, state: Array, u: Array, signal: Array, by_constants: Array) -> None: ...
    def carry_jacobian(self, state: Array, memory: Array, signal: Array, result: Array) -> None: ...

def kinds() -> list[str]: ...

class Rounding:
    def __init__(self, rate: float, contact: float) -> None: ...

class Limits:
    def __init__(self, low: float, high: float, change: float, penalty: float) -> None: ...

class TrackingTerms:
    def __init__(
        self,
        low: float,
        high: float,
        change: float,
        power: int,
        scale: float,
        roughness: float,
        stray: float,
    ) -> None: ...

class Polish:
    def __init__(
        self,
        window: int,
        follow: int,
        trials: int,
        steps: int,
        least: float,
        size: float,
        seed: int,
    ) -> None: ...

class Stepper:
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def __call__(self, u: float, /) -> float: ...

class Moving:
    def __init__(self, at: Sequence[float], knots: Iterable[Iterable[Stage]]) -> None: ...
    @property
    def state_length(self) -> int: ...
    def run(self, state: Array, u: Array, s: Array, y: Array) -> tuple[int, int]: ...

class MovingStepper:
    def __init__(
        self, at: Sequence[float], knots: Iterable[Iterable[Stage]], state: Array
    ) -> None: ...
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    @property
    def outside(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def __call__(self, u: float, s: float, /) -> float: ...

class TrackingController:
    def __init__(
        self,
        a: Sequence[float],
        b: Sequence[float],
        c: Sequence[float],
        d_ref: float,
        d: float,
        inverse: Chain,
    ) -> None: ...
    @property
    def state_length(self) -> int: ...
    def limit(
        self, w: Sequence[float], forward: Chain, low: float, high: float, change: float
    ) -> None: ...
    def run(self, state: Array, y_ref: Array, y: Array, u: Array) -> int: ...
    def tell(
        self,
        state: Array,
        y_ref: Array,
        y: Array,
        e: Sequence[float],
        f_ref: float,
        f: float,
        g: float,
        v: Array,
        d_hat: Array,
    ) -> int: ...

class TrackingStepper:
    def __init__(self, controller: TrackingController, state: Array) -> None: ...
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    @property
    def limited(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def __call__(self, y_ref: float, y: float) -> float: ...

class LimitedDrive:
    @overload
    def __init__(
        self,
        is_inverse: bool,
        chain: Chain,
        forward: Chain,
        low: float,
        high: float,
        change: float,
    ) -> None: ...
    @overload
    def __init__(
        self,
        chain: Chain,
        low: float,
        high: float,
        moved_down: int,
        down: Sequence[float],
        moved_up: int,
        up: Sequence[float],
    ) -> None: ...
    @property
    def state_length(self) -> int: ...
    def run(self, state: Array, x: Array, y: Array) -> tuple[int, int]: ...
    def lead(self, state: Array, u: Array) -> int: ...

class LimitedStepper:
    def __init__(self, drive: LimitedDrive, state: Array) -> None: ...
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    @property
    def limited(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def __call__(self, x: float) -> float: ...

class LimitedMovingStepper:
    def __init__(
        self,
        at: Sequence[float],
        knots: Sequence[Iterable[Stage]],
        forward: Sequence[Iterable[Stage]],
        is_inverse: bool,
        low: float,
        high: float,
        change: float,
        state: Array,
    ) -> None: ...
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    @property
    def limited(self) -> bool: ...
    @property
    def outside(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def run(self, x: Array, s: Array, y: Array) -> tuple[int, int]: ...
    def lead(self, drive: float, s: float) -> bool: ...
    def __call__(self, x: float, s: float) -> float: ...

class RepetitiveController:
    def __init__(
        self,
        period: int,
        lead: int,
        wait: int,
        smooth: Sequence[float],
        learn: Sequence[float],
        tolerance: float,
        inverse: Chain,
    ) -> None: ...
    @property
    def memory_length(self) -> int: ...
    @property
    def state_length(self) -> int: ...
    def limit(self, forward: Chain, low: float, high: float, change: float) -> None: ...
    def run(self, state: Array, y_ref: Array, y: Array, u: Array, v: Array) -> int: ...

class RepetitiveStepper:
    def __init__(self, controller: RepetitiveController, state: Array) -> None: ...
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    @property
    def limited(self) -> bool: ...
    @property
    def changed(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def reset(self) -> None: ...
    def __call__(self, y_ref: float, y: float) -> float: ...

def run_continuous_loop(
    step: Array,
    delayed: bool,
    inverse: Chain,
    hysteresis: Chain,
    inverse_state: Array,
    hysteresis_state: Array,
    r: Array,
    noise: Array,
    before: Array,
    behind: Array,
    outputs: Array,
    limit: float,
) -> tuple[str, int, bool]: ...
def run_sampled_loop(
    step: Array,
    controller: TrackingController,
    e: Sequence[float],
    f_ref: float,
    f: float,
    hysteresis: Chain,
    controller_state: Array,
    hysteresis_state: Array,
    r: Array,
    noise: Array,
    before: Array,
    behind: Array,
    outputs: Array,
    limit: float,
) -> tuple[str, int, bool]: ...
def run_repetitive_loop(
    step: Array,
    controller: RepetitiveController,
    hysteresis: Chain,
    controller_state: Array,
    hysteresis_state: Array,
    r: Array,
    noise: Array,
    before: Array,
    behind: Array,
    outputs: Array,
    limit: float,
) -> tuple[str, int, bool]: ...
def play_gram(
    r: Sequence[float], z: Array, u: Array, y: Array, edges: Sequence[int], result: Array
) -> None: ...
def play_outputs(r: Sequence[float], z: Array, u: Array, result: Array) -> None: ...
def run_with_thresholds(
    p0: float, p: Sequence[float], r: Array, z: Array, u: Array, y: Array
) -> None: ...
def run_batch(
    chain: Chain, theta: Array, state: Array, u: list[Array], y: list[Array], threads: int = 1
) -> tuple[int, int]: ...
def loss_batch(
    chain: Chain,
    theta: Array,
    state: Array,
    u: list[Array],
    y: list[Array],
    loss: Array,
    gradient: Array,
    threads: int = 1,
) -> None: ...
def first_non_finite(values: Array) -> int: ...
def instruction_sets() -> list[str]: ...
def instruction_set() -> str: ...
def use_instruction_set(name: str) -> None: ...
def sample_exact(
    chain: Chain, state: Array, target: Array, u: Array, low: float, high: float
) -> tuple[int, int]: ...
def stepper(chain: Chain, state: Any, y_safe: float) -> Stepper: ...
def tracking_gradient(
    chain: Chain, state: Array, target: Array, u: Array, terms: TrackingTerms, gradient: Array
) -> float: ...
def trajectory_cost(
    chain: Chain,
    state: Array,
    target: Array,
    u: Array,
    roughness: float,
    rounding: Rounding,
    limits: Limits,
) -> float: ...
def trajectory_polish(
    chain: Chain, state: Array, target: Array, u: Array, terms: TrackingTerms, how: Polish
) -> tuple[float, float, int]: ...
def trajectory_step(
    chain: Chain,
    state: Array,
    target: Array,
    u: Array,
    roughness: float,
    rounding: Rounding,
    limits: Limits,
    damping: float,
    result: Array,
) -> float: ...

class JointEstimation:
    def __init__(
        self,
        plays: int,
        limit: Sequence[float],
        front: Sequence[float],
        back: Sequence[float],
        least_map_slope: float,
        most_map_slope: float,
    ) -> None: ...
    def set_bounds(self, least_slope: float, most_slope: float, most_radius: float) -> None: ...
    def set_memory(
        self,
        forgetting: float,
        noise_memory: float,
        least_noise: float,
        least_share: float,
        patience: float,
    ) -> None: ...
    def set_folding(self, quantum: float, coarsest: float, most: float, page: float) -> None: ...
    def folded(self, which: int) -> list[list[float]]: ...
    def folding(self) -> list[float]: ...
    def fold_again(
        self,
        place: Sequence[float],
        rows: Sequence[Sequence[float]],
        before: Sequence[Sequence[float]],
    ) -> None: ...
    def unfold(self) -> None: ...
    def replaced(self, state: Array) -> None: ...
    def set_search(
        self,
        radius: Sequence[float],
        start: Sequence[float],
        limit: Sequence[float],
        noise: float,
    ) -> None: ...
    def places(self) -> dict[str, int]: ...
    def start(self, state: Array, noise: float) -> None: ...
    def step(self, state: Array, u: float, y: float) -> int: ...
    def follow(self, state: Array, u: float) -> None: ...
    def remember(self, state: Array) -> None: ...
    def command(self, state: Array, y_ref: float) -> float: ...
    def constants(self) -> dict[str, list[float]]: ...
    def correlation(self, state: Array) -> float: ...
    def run(
        self,
        state: Array,
        u: Array,
        y: Array,
        every: int,
        theta: Array,
        variance: Array,
        error: Array,
    ) -> None: ...

class RadiusEstimation:
    def __init__(
        self, p0: float, p: Sequence[float], gain: Sequence[float], limit: Sequence[float]
    ) -> None: ...
    def set_method(self, least_squares: bool, growth: float, most_radius: float) -> None: ...
    def set_slope_filter(
        self, memory: float, dead_time: float, dead_band: float, tolerance: float
    ) -> None: ...
    def places(self) -> dict[str, int]: ...
    def start(self, state: Array, z0: Array) -> None: ...
    def step(self, state: Array, u: float, y: float) -> bool: ...
    def step_told(self, state: Array, u: float, y: float, is_slope: bool, told: float) -> bool: ...
    def follow(self, state: Array, u: Array) -> None: ...
    def run(
        self,
        state: Array,
        u: Array,
        y: Array,
        every: int,
        r: Array,
        error: Array,
        is_slope: bool,
        told: Array,
    ) -> None: ...

class ScaleEstimation:
    def __init__(
        self,
        forgetting: float,
        patience: float,
        spread: float,
        least: float,
        most: float,
        scale_held: bool,
        offset_held: bool,
    ) -> None: ...
    def places(self) -> dict[str, int]: ...
    def constants(self) -> list[float]: ...
    def start(self, state: Array, start: float, offset: float) -> None: ...
    def step(self, state: Array, w: float, y: float) -> int: ...
    def run(
        self,
        state: Array,
        w: Array,
        y: Array,
        every: int,
        theta: Array,
        variance: Array,
        error: Array,
    ) -> None: ...

def project_radii(r: Array, most: float) -> None: ...
def has_number_text() -> bool: ...
def rows_as_text(columns: Sequence[Array], start: int, stop: int) -> bytes: ...
def text_as_rows(
    text: bytes, start: int, stop: int, separator: str, used: Sequence[int], values: Array
) -> bool: ...
