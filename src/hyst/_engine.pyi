"""Types of the compiled engine."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

class Chain:
    def __init__(self) -> None: ...
    def add_affine(self, gain: float, offset: float) -> None: ...
    def add_play(self, r: float) -> None: ...
    def add_stop(self, r: float) -> None: ...
    def add_dead_zone(
        self, weights: Sequence[float], thresholds: Sequence[float], by_direction: bool
    ) -> None: ...
    def add_pi(self, p0: float, p: Sequence[float], r: Sequence[float]) -> None: ...
    def add_rate_dependent_pi(
        self,
        p0: float,
        p: Sequence[float],
        r: Sequence[float],
        beta: float,
        powers: Sequence[float],
        slopes: Sequence[float],
        knees: Sequence[float],
        dt: float,
    ) -> None: ...
    def add_state_space(
        self, delay: int, a: Sequence[float], b: Sequence[float], c: Sequence[float], d: float
    ) -> None: ...
    def add_sections(self, coefficients: Sequence[float]) -> None: ...
    def add_masing(
        self,
        curve: str,
        constants: Sequence[float],
        least_slope: float,
        inverse: bool,
        last_reversal: bool,
        depth: int,
        dead_band: float,
    ) -> None: ...
    def add_memory_element(
        self,
        function: str,
        knots: Sequence[float],
        constants: Sequence[float],
        inverse: bool,
        absolute: bool,
        is_reset: bool,
        reset_to: float,
        dt: float,
    ) -> None: ...
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
    def jacobian(self, state: Array, u: Array, result: Array) -> None: ...

class Rounding:
    def __init__(self, rate: float, contact: float) -> None: ...

class Limits:
    def __init__(self, low: float, high: float, change: float, penalty: float) -> None: ...

class Stepper:
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def __call__(self, u: float, /) -> float: ...

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
    def run(self, state: Array, y_ref: Array, y: Array, u: Array) -> int: ...

class TrackingStepper:
    def __init__(self, controller: TrackingController, state: Array) -> None: ...
    @property
    def state(self) -> Array: ...
    @property
    def fault(self) -> bool: ...
    def clear_fault(self) -> None: ...
    def __call__(self, y_ref: float, y: float) -> float: ...

def run_continuous_loop(
    step: Array,
    delayed: bool,
    inverse: Chain,
    hysteresis: Chain,
    inverse_state: Array,
    hysteresis_state: Array,
    inputs: Array,
    outputs: Array,
    limit: float,
) -> tuple[str, int]: ...
def run_sampled_loop(
    step: Array,
    controller: TrackingController,
    hysteresis: Chain,
    controller_state: Array,
    hysteresis_state: Array,
    inputs: Array,
    outputs: Array,
    limit: float,
) -> tuple[str, int]: ...
def play_gram(
    r: Sequence[float], z: Array, u: Array, y: Array, edges: Sequence[int], result: Array
) -> None: ...
def play_outputs(r: Sequence[float], z: Array, u: Array, result: Array) -> None: ...
def run_with_thresholds(
    p0: float, p: Sequence[float], r: Array, z: Array, u: Array, y: Array
) -> None: ...
def run_parameter_sets(
    p0: Array, p: Array, r: Array, u: Array, y: Array, threads: int = 1
) -> int: ...
def first_non_finite(values: Array) -> int: ...
def instruction_sets() -> list[str]: ...
def instruction_set() -> str: ...
def use_instruction_set(name: str) -> None: ...
def sample_exact(
    chain: Chain, state: Array, target: Array, u: Array, low: float, high: float
) -> tuple[int, int]: ...
def stepper(chain: Chain, state: Any, y_safe: float) -> Stepper: ...
def trajectory_cost(
    chain: Chain,
    state: Array,
    target: Array,
    u: Array,
    roughness: float,
    rounding: Rounding,
    limits: Limits,
) -> float: ...
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
    def run(self, state: Array, u: Array, y: Array, every: int, r: Array, error: Array) -> None: ...

def project_radii(r: Array, most: float) -> None: ...
