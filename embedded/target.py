"""Processors, their compilers' options, and the emulator's clock."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass

from hyst.export.c.numbers import Precision

COMPILER = "arm-none-eabi-gcc"
EMULATOR = "qemu-system-arm"
NEEDED = (COMPILER, "arm-none-eabi-size", "arm-none-eabi-nm", EMULATOR)

# An instruction takes 2^8 ns of the emulator's time and SysTick counts the boards' 25 MHz, so there
# are 6.4 ticks to an instruction and a single one can be told; with shift=0 there would be 40
# instructions to a tick.
ICOUNT_SHIFT = 8
TICKS_PER_INSTRUCTION = 2**ICOUNT_SHIFT * 25e6 / 1e9

STRICT = (
    "-std=c99",
    "-ffp-contract=off",
    "-ffreestanding",
    "-ffunction-sections",
    "-fdata-sections",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wpedantic",
    "-Wshadow",
    "-Werror",
)


@dataclass(frozen=True)
class Processor:
    """A processor, its board in the emulator, the compiler's options, and what it cannot do."""

    name: str
    board: str
    options: tuple[str, ...]
    lacks_double: bool


M4F = Processor("Cortex-M4F", "mps2-an386", ("-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16"), True)
M7 = Processor("Cortex-M7", "mps2-an500", ("-mcpu=cortex-m7", "-mfpu=fpv5-d16"), False)


@dataclass(frozen=True)
class Build:
    """One way to compile a model: for a processor, in a precision, at an optimisation level."""

    processor: Processor
    precision: Precision
    level: str

    @property
    def name(self) -> str:
        return f"{self.processor.name} {self.precision} {self.level}"

    @property
    def options(self) -> tuple[str, ...]:
        single = ("-Wdouble-promotion",) if self.precision == "single" else ()
        return (*self.processor.options, "-mthumb", "-mfloat-abi=hard", self.level, *single)


MAIN = Build(M4F, "single", "-O2")
SMALL = Build(M4F, "single", "-Os")
FAST = Build(M7, "single", "-O2")
FAST_DOUBLE = Build(M7, "double", "-O2")
SOFT_DOUBLE = Build(M4F, "double", "-O2")
BUILDS = (MAIN, SMALL, FAST, FAST_DOUBLE, SOFT_DOUBLE)


def missing_tools() -> list[str]:
    """Give the programs that are needed and not installed."""
    return [each for each in NEEDED if shutil.which(each) is None]


def run(command: list[str], seconds: float = 60.0) -> str:
    """Run a program and give what it wrote; what it complained of is the error's text."""
    try:
        finished = subprocess.run(
            command, capture_output=True, text=True, timeout=seconds, check=False
        )
    except subprocess.TimeoutExpired:
        raise RuntimeError(f"{command[0]} did not end within {seconds:g} s") from None
    if finished.returncode != 0:
        said = (finished.stderr + finished.stdout).strip()
        raise RuntimeError(f"{command[0]} failed with {finished.returncode}: {said[-2000:]}")
    return finished.stdout + finished.stderr


def compiler_version() -> str:
    """Give the version of the cross compiler, as 12.2.1."""
    return run([COMPILER, "-dumpfullversion"]).strip()
