"""FMUs as an importer sees them: one small interface to FMPy's two, and the models to try."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave

import hyst
from hyst import DeadZone, ModifiedPrandtlIshlinskii, Operator, PrandtlIshlinskii
from hyst.control import TrackingController
from hyst.export.c.core_stage import core_stages
from hyst.online import JointEstimator
from reference.examples import EXAMPLES, PI

VERSIONS = ("2.0", "3.0")
WARNING, ERROR = 1, 3

has_compiler = pytest.mark.skipif(
    not any(map(shutil.which, ("cc", "gcc", "clang"))), reason="there is no C compiler"
)


def one_of_each(operators: dict[str, Operator]) -> dict[str, Operator]:
    """The first operator of every shape of code: kinds, forms and switches of the stages."""
    found: dict[Any, str] = {}
    for name, operator in operators.items():
        shape = tuple(
            (
                stage.kind,
                stage.form,
                tuple(sorted(stage.choices.items())) if stage.kind != "masing" else
                (stage.choices["inverse"], stage.choices["last_reversal"]),
                tuple(bool(values) for values in stage.tables.values()),
            )
            for stage in core_stages(operator)
        )  # fmt: skip
        starts = bool(np.any(operator.initial_state()))
        found.setdefault((shape, starts), name)
    return {name: operators[name] for name in found.values()}


SHAPES = one_of_each(EXAMPLES)

MPI = ModifiedPrandtlIshlinskii(
    PrandtlIshlinskii(np.linspace(0.3, 0.05, 10), np.linspace(0.1, 2.0, 10), p0=1.0),
    DeadZone([1.0, 0.2, 0.1, 0.3], [0.0, 0.5, 1.5, -0.4]),
)
INVERSE_MPI = MPI.inverse()

CONTROLLER = TrackingController(
    [[0.9, 0.1], [0.0, 0.5]], [[1.0, -1.0], [0.2, 0.3]], [0.5, 0.1], [0.7, 0.0],
    dt=1e-3, inverse=PI.inverse(),
)  # fmt: skip


LIMITED_CONTROLLER = TrackingController.from_continuous(
    ([0.5, 40.0], [1.0, 0.0]), 1e-3, observer=([[-2.0]], [[0.5, -1.0]], [[1.0]], [[0.0, 0.25]]),
    inverse=INVERSE_MPI, limits=(-1.5, 2.0), rate=900.0,
)  # fmt: skip


def estimation() -> tuple[JointEstimator, np.ndarray, np.ndarray, np.ndarray]:
    """A fresh estimator; input, measured output and reference, some samples of them missing."""
    truth = PrandtlIshlinskii(1.2 * PI.p, 0.9 * PI.r, p0=0.4)
    u, y_ref = rough_signal(400, 1), rough_signal(400, 3)
    y = truth(u) + np.random.default_rng(0).normal(0.0, 0.01, u.size)
    u[70], y[100], y_ref[130] = np.inf, np.nan, np.nan
    return JointEstimator(PI, dt=1e-3), u, y, y_ref


def estimated(
    estimator: JointEstimator, u: np.ndarray, y: np.ndarray, y_ref: np.ndarray
) -> np.ndarray:
    """The commands, each after the sample has been taken in; without a number, the last input."""
    commands, last = np.empty(u.size), 0.0
    for k in range(u.size):
        if estimator.update(u[k], y[k]):
            last = u[k]
        command = estimator.command(y_ref[k])
        commands[k] = command if np.isfinite(command) else last
    return commands


def rough_signal(samples: int, seed: int = 0, size: float = 6.0) -> np.ndarray:
    """Runs, reversals, jumps and plateaus."""
    rng = np.random.default_rng(seed)
    t = np.arange(samples)
    u = size * np.sin(0.05 * t + rng.uniform(0, 6)) * np.cos(0.017 * t) + rng.normal(
        0, 0.4, samples
    )
    u[samples // 3 : samples // 3 + 5] = u[samples // 3]
    return np.asarray(u)


class FmuRun:
    """One instance of an FMU that has been written."""

    def __init__(
        self, written: hyst.export.Fmu, folder: Path, name: str = "one", token: str = ""
    ) -> None:
        self.log: list[tuple[int, str]] = []
        unpacked = folder / f"{written.path.stem}-unpacked"
        if not unpacked.exists():
            fmpy.extract(str(written.path), str(unpacked))
        self.description = fmpy.read_model_description(str(unpacked), validate=True)
        self.variables = {each.name: each for each in self.description.modelVariables}
        self.is_2 = written.version == "2.0"
        arguments: dict[str, Any] = {
            "guid": token or self.description.guid,
            "unzipDirectory": str(unpacked),
            "modelIdentifier": written.name,
            "instanceName": name,
        }
        self.fmu = (FMU2Slave if self.is_2 else FMU3Slave)(**arguments)
        if self.is_2:
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = fmi2CallbackLoggerTYPE(self._log_2)
            self._callbacks = callbacks
            self.fmu.instantiate(callbacks=callbacks)
        else:
            self.fmu.instantiate(logMessage=self._log_3)

    def _log_2(self, _env: Any, _name: Any, status: int, _category: Any, message: bytes) -> None:
        self.log.append((status, message.decode()))

    def _log_3(self, _env: Any, status: int, _category: Any, message: bytes) -> None:
        self.log.append((status, message.decode()))

    def initialize(self, time: float = 0.0, **values: float) -> FmuRun:
        self.set(**values)
        if self.is_2:
            self.fmu.setupExperiment(startTime=time)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=time)
        self.fmu.exitInitializationMode()
        return self

    def set(self, **values: float) -> None:
        self.set_all(values)

    def set_all(self, values: dict[str, float]) -> None:
        references = [self.variables[name].valueReference for name in values]
        setter = self.fmu.setReal if self.is_2 else self.fmu.setFloat64
        setter(references, list(values.values()))

    def get(self, name: str) -> float:
        getter = self.fmu.getReal if self.is_2 else self.fmu.getFloat64
        if name == "fault":
            getter = self.fmu.getInteger if self.is_2 else self.fmu.getUInt32
        return getter([self.variables[name].valueReference])[0]

    def step(self, time: float, size: float) -> None:
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def run(self, u: np.ndarray, dt: float, start: int = 0) -> np.ndarray:
        y = np.empty(u.size)
        for k, value in enumerate(u.tolist()):
            self.set(u=value)
            self.step((start + k) * dt, dt)
            y[k] = self.get("y")
        return y

    @contextlib.contextmanager
    def refusal(self, status: int) -> Iterator[list[str]]:
        """Expect a call to return a status, and give what it logged."""
        before, said = len(self.log), []
        with pytest.raises(FMICallException) as refused:
            yield said
        assert refused.value.status == status
        new = self.log[before:]
        assert [each[0] for each in new] == [status], new
        said.append(new[0][1])

    def free(self) -> None:
        self.fmu.freeInstance()
