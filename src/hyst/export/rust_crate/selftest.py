"""The self-test of a crate, with the vectors of the C one."""

from __future__ import annotations

import struct
from collections.abc import Iterable

from hyst.export.c.drive import PERIOD
from hyst.export.c.exported import Block
from hyst.export.c.numbers import Precision
from hyst.export.c.selftest import BAD, SECOND_RESTS, SEEDS, SelfTest
from hyst.export.c.templating import filled, indented
from hyst.export.rust_crate.names import rust_name


def selftest_source(block: Block, places: dict[str, str]) -> str:
    """Give the self-test of a ``block``, filled with ``places``."""
    driven = block.inputs[:1] if block.second or block.is_estimator else block.inputs
    drives = "\n".join(
        f"let mut drive_{each} = Drive::of({seed});"
        for each, seed in zip(driven, SEEDS, strict=False)
    )
    drawn = [
        f"let {rust_name(each)} = drive_{each}.next(k, {bad});"
        for each, bad in zip(driven, BAD, strict=False)
    ]
    if block.is_estimator:
        drawn += [
            "let measured = Real::from_bits(MEASURED[k]);",
            f"let y = if k % DRIVE_PERIOD == {BAD[1]} {{ Real::NAN }} else {{ measured }};",
            f"let _ = block.update({rust_name(driven[0])}, y);",
            "let result = block.command(measured);",
        ]
    else:
        if block.second:
            drawn.append(
                f"let s = if k % DRIVE_PERIOD == {BAD[1]} {{ Real::NAN }} else {{ "
                f"Real::from_bits(SECOND[(k / {SECOND_RESTS}) % SECOND.len()]) }};"
            )
        drawn.append(f"let result = block.step({places['inputs']});")
    more = {"drives": indented(drives), "drawn": indented("\n".join(drawn), 8)}
    return filled("rust/selftest.rs", places | more)


def vectors(block: Block, test: SelfTest, precision: Precision) -> str:
    """Give the input and what Python makes of it, numbers as their bits.

    Parameters
    ----------
    block
        What is exported.
    test
        The self-test.
    precision
        Of the target.
    """
    drive = test.drive
    word = "u32" if precision == "single" else "u64"
    lines = [
        "//! What the self-test expects; numbers as their bits.\n",
        f"pub const DRIVE_LOW: i32 = {drive.low};\n",
        f"pub const DRIVE_COUNT: i32 = {drive.count};\n",
        f"pub const DRIVE_STRIDE: i32 = {drive.stride};\n",
        f"pub const DRIVE_PERIOD: usize = {PERIOD};\n",
        f"pub const DRIVE_UNIT: {word} = {_bits(drive.unit, precision)};\n",
        _table("EXPECTED", test.expected.tolist(), precision),
    ]
    if test.measured is not None:
        lines.append(_table("MEASURED", test.measured.tolist(), precision))
    if block.second:
        lines.append(_table("SECOND", block.second, precision))
    return "".join(lines)


def _table(name: str, values: Iterable[float], precision: Precision) -> str:
    words = [_bits(each, precision) for each in values]
    rows = "".join(f"    {', '.join(words[k : k + 4])},\n" for k in range(0, len(words), 4))
    word = "u32" if precision == "single" else "u64"
    return f"#[rustfmt::skip]\npub static {name}: [{word}; {len(words)}] = [\n{rows}];\n"


def _bits(value: float, precision: Precision) -> str:
    if precision == "single":
        return f"0x{struct.unpack('<I', struct.pack('<f', value))[0]:08x}"
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016x}"
