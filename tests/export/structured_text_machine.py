"""Run structured text: its function block compiled by way of C and called from Python."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from structured_text_compiler import Compiler
from structured_text_parser import ArrayOf, StructuredTextError
from structured_text_standard import C_TYPES

NUMPY = {"BOOL": np.int8, "DINT": np.int32, "UDINT": np.uint32, "DWORD": np.uint32,
         "REAL": np.float32, "LREAL": np.float64}  # fmt: skip


class Machine:
    """A function block of a text, compiled; each ``instance()`` is one."""

    def __init__(self, text: str, block: str, folder: Path, driver: str = "gcc") -> None:
        compiler = Compiler(text)
        self.unit = compiler.blocks[block.lower()]
        low = block.lower()
        signals = [v for v in self.unit.variables if v.role in ("VAR_INPUT", "VAR_OUTPUT")]
        signals = [v for v in signals if not isinstance(v.type, ArrayOf)]
        self.signals = {v.name: v for v in signals}
        arrays = [
            v for v in self.unit.variables if isinstance(v.type, ArrayOf) and v.role == "VAR_INPUT"
        ]
        self.arrays = {v.name: v.type for v in arrays}
        lines = [
            *compiler.lines,
            f"size_t size_of(void) {{ return sizeof(t_{low}); }}",
            f"void begin(t_{low} *self) {{ *self = start_{low}; }}",
            *(
                f"void set_{v.name}(t_{low} *self, const void *from) "
                f"{{ memcpy(self->{compiler.c_name(v.name)}, from, "
                f"sizeof self->{compiler.c_name(v.name)}); }}"
                for v in arrays
            ),
            "int run(void *it, size_t samples, void *const *all, const int8_t *runs)\n{",
            f"t_{low} *const self = it; stopped_at = 0;",
            "if (setjmp(stopped)) { return stopped_at; }",
            "for (size_t k = 0; k < samples; ++k) { fuel = TURNS;",
        ]
        for role, write in (("VAR_INPUT", "self->{0} = (({1} *)all[{2}])[k];"),
                            ("VAR_OUTPUT", "(({1} *)all[{2}])[k] = self->{0};")):  # fmt: skip
            for place, each in enumerate(signals):
                if each.role == role:
                    name = compiler.c_name(each.name)
                    code = write.format(name, C_TYPES[each.type], place)
                    lines.append(f"if (runs[{place}]) {{ {code} }}")
            if role == "VAR_INPUT":
                lines.append(f"f_{low}(self);")
        lines.append("}\nreturn 0;\n}")
        source, library = folder / f"{low}_machine.c", folder / f"{low}_machine.so"
        source.write_text("\n".join(lines))
        command = [driver, "-std=c99", "-O1", "-ffp-contract=off", "-fPIC", "-shared", "-w",
                   str(source), "-o", str(library), "-lm"]  # fmt: skip
        finished = subprocess.run(command, capture_output=True, text=True, check=False)
        assert finished.returncode == 0, finished.stderr
        self.compiled = ctypes.CDLL(str(library))
        self.compiled.size_of.restype = ctypes.c_size_t

    def instance(self) -> Instance:
        return Instance(self)


class Instance:
    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.bytes = ctypes.create_string_buffer(machine.compiled.size_of())
        machine.compiled.begin(self.bytes)

    def set(self, name: str, values: Any) -> None:
        """Give an input that is an array; what is not given is 0."""
        of = self.machine.arrays[name]
        all_of_them = np.zeros(of.high - of.low + 1, NUMPY[of.of])
        all_of_them[: np.size(values)] = values
        getattr(self.machine.compiled, f"set_{name}")(
            self.bytes, all_of_them.ctypes.data_as(ctypes.c_void_p)
        )

    def run(self, outputs: tuple[str, ...], **inputs: Any) -> tuple[np.ndarray, ...]:
        """Call the block for every sample; an input that is not given keeps its value."""
        signals = self.machine.signals
        samples = max(np.size(each) for each in inputs.values())
        arrays: dict[str, np.ndarray] = {}
        for name, value in inputs.items():
            of = NUMPY[signals[name].type]
            arrays[name] = np.ascontiguousarray(np.broadcast_to(value, samples), of)
        for name in outputs:
            arrays[name] = np.empty(samples, NUMPY[signals[name].type])
        pointers = [arrays[n].ctypes.data if n in arrays else None for n in signals]
        runs = np.array([n in arrays for n in signals], np.int8)
        line = self.machine.compiled.run(
            self.bytes,
            ctypes.c_size_t(samples),
            (ctypes.c_void_p * len(pointers))(*pointers),
            ctypes.c_void_p(runs.ctypes.data),
        )
        if line:
            raise StructuredTextError(f"line {line}: out of bounds, or a loop without an end")
        return tuple(arrays[name] for name in outputs)
