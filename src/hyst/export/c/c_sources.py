"""The C of an exported block: header, source and self-test."""

from __future__ import annotations

from hyst import __version__
from hyst.export.c import driver_codes
from hyst.export.c.block import Block
from hyst.export.c.drive import PERIOD, SAMPLES
from hyst.export.c.names import plain_text
from hyst.export.c.numbers import Precision, literal, table
from hyst.export.c.readme_rows import signals
from hyst.export.c.selftest import BAD, SECOND_RESTS, SEEDS, SelfTest
from hyst.export.c.short_test import SHORT_SAMPLES
from hyst.export.c.start_code import answer, beginning, start_tables
from hyst.export.c.start_code import declared as start_declared
from hyst.export.c.templating import filled, indented
from hyst.operators import ModelDescription

WORD_BYTES = {"double": 8, "single": 4}


def places(
    block: Block, name: str, precision: Precision, about: ModelDescription
) -> dict[str, str]:
    """Give what the templates of a block have in common.

    Parameters
    ----------
    block
        What is exported.
    name
        The prefix, checked.
    precision
        Of the target.
    about
        What the numbers mean.

    Returns
    -------
    dict
    """
    length = max(len(block.start), 1)
    single = precision == "single"
    return {
        "name": name,
        "NAME": name.upper(),
        "version": plain_text(__version__),
        "title": f"{plain_text(block.kind)} as C, {precision} precision",
        "precision": precision,
        "state_length": str(len(block.start)),
        "memory_length": str(length),
        "saved_bytes": str(12 + WORD_BYTES[precision] * (length + 1)),
        "word": "uint32_t" if single else "uint64_t",
        "word_bytes": str(WORD_BYTES[precision]),
        "zero": answer(block.virgin[1], precision),
        "rest": answer(block.virgin[1], precision),
        "rest_said": f"{block.virgin[1]:.6g}",
        "clamped": _clamped(block, name),
        "fault_there": _fault(block, name, "state"),
        "fault_here": _fault(block, name, "&state"),
        "identity": f"0x{block.identity(precision):08x}",
        "output": block.output,
        "first": block.inputs[0],
        "arguments": ", ".join(f"hyst_real {each}" for each in block.inputs),
        "records": ", ".join(f"const hyst_real *{each}" for each in block.inputs),
        "elements": ", ".join(f"{each}[k]" for each in block.inputs),
        "samples": str(SAMPLES),
        "short_samples": str(SHORT_SAMPLES),
        "signals": _signals(block, about),
        "more_faults": block.faults.replace("@{NAME}", name.upper()),
        "raised": _raised(block, name.upper()),
        **_reset(block, name),
        "sample_time": _sample_time(block, name) + block.drive.defined(name),
        "answered": _answered(block, name),
        "start_declared": start_declared(block, name),
        "codes_declared": driver_codes.declared(block, name),
        # What a refused sample leaves in an estimator's scratch area is of no use.
        "saved_number": "hyst_is_finite(state->memory[i]) ? state->memory[i] : HYST_REAL(0.0)"
        if block.is_estimator
        else "state->memory[i]",
        **block.more,
    }


def header(block: Block, places: dict[str, str]) -> str:
    """Give the header file of a ``block``, filled with ``places``."""
    return filled(f"{_template(block)}.h", places)


def source(block: Block, places: dict[str, str], precision: Precision) -> str:
    """Give the source file of a ``block`` in a ``precision``, filled with ``places``."""
    uses_memory = "memory" in block.body
    coded = () if block.codes is None else (driver_codes.HEADER,)
    more = {
        "includes": "".join(
            f'#include "{each}"\n' for each in sorted({"hyst/finite.h", *block.headers, *coded})
        ),
        "declarations": start_tables(block, precision) + block.head + driver_codes.tables(block),
        "beginning": beginning(block, places["name"], precision),
        "memory": "    hyst_real *const memory = state->memory;\n" if uses_memory else "",
        "calls": indented(block.body.replace("@{NAME}", places["NAME"])),
        "signal": block.signal,
    }
    template = block.source_template or _template(block)
    text = filled(f"{template}.c", places | more) + filled("state.c", places)
    return text + driver_codes.defined(block, places["name"])


def selftest_source(block: Block, places: dict[str, str]) -> str:
    """Give the self-test of a ``block``, filled with ``places``."""
    shared = places | {"drive": filled("drive.c", {})}
    if block.is_estimator:
        bad = {"bad_u": str(BAD[0]), "bad_y": str(BAD[1])}
        return filled("estimator_selftest.c", shared | bad)
    driven = block.inputs[:1] if block.second else block.inputs
    drives = [f"drive_{each}" for each in driven]
    lines = [
        f"static drive {each} = {{{seed}u, DRIVE_LOW, DRIVE_LOW, 1}};"
        for each, seed in zip(drives, SEEDS, strict=False)
    ]
    drawn = [
        f"const hyst_real {name} = next_sample(&{each}, k, {bad}u);"
        for name, each, bad in zip(driven, drives, BAD, strict=False)
    ]
    if block.second:
        drawn.append(
            f"const hyst_real s = k % DRIVE_PERIOD == {BAD[1]}u ? (hyst_real)NAN : "
            f"second[(k / {SECOND_RESTS}u) % {len(block.second)}u];"
        )
    more = {
        "ones": ", ".join("1" for _ in block.inputs),
        "drives": indented("\n".join(lines)) + "\n",
        "samples_drawn": indented("\n".join(drawn), 8) + "\n",
        "arguments": ", ".join(block.inputs),
    }
    return filled("selftest.c", shared | more)


def vectors(block: Block, test: SelfTest, places: dict[str, str], precision: Precision) -> str:
    """Give the header with what a self-test expects.

    Parameters
    ----------
    block, test
        What is exported, and its self-test.
    places
        What stands at every place.
    precision
        Of the target.
    """
    drive = test.drive
    more = {
        "low": f"({drive.low})",
        "count": str(drive.count),
        "stride": str(drive.stride),
        "period": str(PERIOD),
        "unit": literal(drive.unit, precision, "unit"),
        "measured": _measured(test, precision) + _second(block, precision),
        "expected": table(test.expected.tolist(), precision, "expected"),
    }
    return filled("selftest_vectors.h", places | more)


def _answered(block: Block, name: str) -> str:
    """Give the end of an estimator's command: finite, and within the limits of the drive."""
    if block.drive.limits is None:
        return "    return hyst_is_finite(u) ? u : state->y_last;\n"
    low, high = f"{name.upper()}_U_MIN", f"{name.upper()}_U_MAX"
    return (
        "    u = hyst_is_finite(u) ? u : state->y_last;\n"
        f"    u = u < {low} ? {low} : u;\n    return u > {high} ? {high} : u;\n"
    )


def _clamped(block: Block, name: str) -> str:
    """Say in a header what clamps an estimator's command."""
    if block.drive.limits is None:
        return ""
    ends = f"{name.upper()}_U_MIN to {name.upper()}_U_MAX"
    return f" It never leaves\n * {ends}; no bit of the fault tells that it would have."


def _fault(block: Block, name: str, state: str) -> str:
    """Give the fault as the self-test reads it: its input need not meet limits, for one."""
    fault = f"{name}_fault({state})"
    return f"({' | '.join([fault, *told(block, name)])})" if block.tells else fault


def told(block: Block, name: str) -> list[str]:
    """Give the bits of the fault of a ``block`` called ``name`` that no bad sample raises."""
    return [f"{name.upper()}_{each}" for each in block.tells]


def bad_samples(block: Block, name: str, state: str) -> str:
    """Give the fault of a ``block`` called ``name`` without what it tells, of a ``state``."""
    fault, bits = f"{name}_fault({state})", told(block, name)
    if not bits:
        return fault
    return f"({fault} & ~{bits[0] if len(bits) == 1 else '(' + ' | '.join(bits) + ')'})"


def _raised(block: Block, prefix: str) -> str:
    bits = [f"{prefix}_NOT_FINITE"]
    if block.second:
        bits.append(f"{prefix}_OFF_SCHEDULE")
    bits += [f"{prefix}_{each}" for each in block.tells]
    return bits[0] if len(bits) == 1 else f"({' | '.join(bits)})"


def _template(block: Block) -> str:
    return "estimator" if block.is_estimator else "block"


def _measured(test: SelfTest, precision: Precision) -> str:
    if test.measured is None:
        return ""
    values = table(test.measured.tolist(), precision, "measured")
    return f"static const hyst_real measured[SAMPLES] = {values};\n"


def _second(block: Block, precision: Precision) -> str:
    if not block.second:
        return ""
    values = table(block.second, precision, "second")
    return f"static const hyst_real second[{len(block.second)}] = {values};\n"


def _signals(block: Block, about: ModelDescription) -> str:
    lines = [""]
    for role, (name, unit) in signals(block, about).items():
        said = f" in {plain_text(unit)}" if unit else ""
        lines.append(f" *   {role}: {plain_text(name)}{said}")
    return "\n".join(lines) + "\n" if len(lines) > 1 else "\n"


def _reset(block: Block, name: str) -> dict[str, str]:
    """Give declaration and definition of what forgets, where there is anything to forget."""
    if block.forgets == 0:
        return {"reset_declared": "", "reset_defined": ""}
    signature = f"void {name}_reset({name}_state *state)"
    return {
        "reset_declared": "\n/* Forgets what was learned of a reference, for another one. What is "
        f"known of the actuator stays. */\n{signature};\n",
        "reset_defined": f"\n{signature}\n{{\n    size_t i;\n"
        f"    for (i = 0; i < {block.forgets}u; ++i) {{\n"
        "        state->memory[i] = HYST_REAL(0.0);\n    }\n}\n",
    }


def _sample_time(block: Block, name: str) -> str:
    if block.dt is None:
        return ""
    return (
        f"#define {name.upper()}_DT HYST_REAL({float(block.dt)!r}) "
        "/* seconds between samples; the model holds for no other */\n"
    )
