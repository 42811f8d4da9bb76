"""Functions that the core writes with the bits of a number: their equals in plain arithmetic.

Structured text cannot look at the bits of a number without what one vendor alone has. Scaling by
powers of two is exact, so the same results come about; a test compares all of them with the C.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from hyst.errors import HystError
from hyst.export.c.templating import filled
from hyst.export.iec61131.numbers import real_text
from hyst.export.iec61131.plan import Plan

_LITERAL = re.compile(r"<([\d.e+-]+)>")
_FUNCTION = re.compile(r"^FUNCTION (\w+) .*?^END_FUNCTION\n", re.MULTILINE | re.DOTALL)
KNOWN = ("power_of_two", "log2", "exp2", "root")

# Bits after the point, bias, largest power of two that scales, and what the C begins roots with.
_FORMATS: dict[str, dict[str, int]] = {
    "double": {"bits": 52, "bias": 1023, "top": 512, "up": 54, "steps": 4,
               "seed": 0x5FE6EB50C7B537A9, "half": 0x3FE6A09E667F3BCD},
    "single": {"bits": 23, "bias": 127, "top": 64, "up": 24, "steps": 3,
               "seed": 0x5F3759DF, "half": 0x3F3504F3},
}  # fmt: skip


def whole_part(plan: Plan) -> str:
    """Give the function that cuts off the fraction, however a compiler rounds to whole numbers."""
    real, name = plan.real, plan.whole_part_name
    half, one = (real_text(each, plan.precision) for each in (0.5, 1.0))
    zero = real_text(0.0, plan.precision)
    return f"""FUNCTION {name} : DINT
VAR_INPUT
    x : {real};
END_VAR
VAR
    size : {real};
    count : DINT;
END_VAR
size := x;
IF x < {zero} THEN
    size := -x;
END_IF;
count := {real}_TO_DINT(size - {half});
IF DINT_TO_{real}(count) > size THEN
    count := count - 1;
END_IF;
IF size - DINT_TO_{real}(count) >= {one} THEN
    count := count + 1;
END_IF;
IF x < {zero} THEN
    count := -count;
END_IF;
{name} := count;
END_FUNCTION
"""


def bit_functions(plan: Plan) -> str:
    """Give the text of those that a program needs, in the order of their calls.

    Raises
    ------
    HystError
        If the program looks at bits in a function that is not known here.
    """
    needed = set()
    for each in plan.usage.by_hand:
        last = each.rsplit("_", 1)[-1]
        if last not in KNOWN:
            raise HystError(f"{each} reads the bits of a number and has no equal here")
        needed.add(last)
    if not needed:
        return ""
    if "exp2" in needed:
        plan.whole_part()
    if needed & {"exp2", "root"}:
        needed.add("power_of_two")
    text = _all_functions(plan)
    found = {match[1]: match[0] for match in _FUNCTION.finditer(text)}
    head = text[: text.index("FUNCTION")]
    return head + "\n".join(found[f"{plan.name}_{each}"] for each in KNOWN if each in needed)


def _all_functions(plan: Plan) -> str:
    of, single = _FORMATS[plan.precision], plan.precision == "single"
    number = np.float32 if single else np.float64

    def text(value: float) -> str:
        return real_text(float(number(value)), plan.precision)

    mask = (1 << of["bits"]) - 1
    word: Any = np.uint32 if single else np.uint64
    half = float(np.array(of["half"], word).view(number))
    unit = 2.0 ** of["bits"]
    values = {
        "name": plan.name,
        "real": plan.real,
        "least_normal": text(2.0 ** (1 - of["bias"])),
        "largest": text(float(np.finfo(number).max)),
        "scale_up": text(2.0 ** of["up"]),
        "scale_up_exponent": text(of["up"]),
        "sign_exponent": text(2.0 * (of["bias"] + 1)),
        "bias": text(of["bias"]),
        "bias_whole": str(of["bias"]),
        "infinite_exponent": text(of["bias"] + 1),
        "most": text(of["bias"] + 5),
        "below": text(of["bias"] + of["bits"] + 5),
        "half_unit": text(unit / 2.0),
        "unit": text(unit),
        "one_of_unit": text(1.0 / unit),
        "seed_exponent": str(of["seed"] >> of["bits"]),
        "seed_fraction": text(of["seed"] & mask),
        "root_steps": str(of["steps"]),
        "powers": _powers(of["top"], text),
        "scalings": _scalings(of["top"], half, text, "k", text),
        "root_scalings": _scalings(of["top"], 1.0, text, "e", lambda value: str(int(value))),
    }
    return _LITERAL.sub(lambda found: text(float(found[1])), filled("bits.st", values))


def _halvings(top: int) -> list[int]:
    return [1 << place for place in range(top.bit_length() - 1, -1, -1)]


def _powers(top: int, text: Any) -> str:
    lines = []
    for each in [top, *_halvings(top)]:
        up, down = text(2.0**each), text(2.0**-each)
        lines += _scaled(f"left_over >= {each}", "power", up, "left_over", f"- {each}")
        lines += _scaled(f"left_over <= {-each}", "power", down, "left_over", f"+ {each}")
    return "\n".join(lines)


def _scalings(top: int, low: float, text: Any, counter: str, count: Any) -> str:
    """Give the lines that bring m to ``low`` <= m < 2 ``low``."""
    lines = []
    for each in [top, *_halvings(top)]:
        up, down = text(low * 2.0**each), text(low * 2.0 ** (1 - each))
        lines += _scaled(f"m >= {up}", "m", text(2.0**-each), counter, f"+ {count(each)}")
        lines += _scaled(f"m < {down}", "m", text(2.0**each), counter, f"- {count(each)}")
    return "\n".join(lines)


def _scaled(condition: str, scaled: str, by: str, counter: str, change: str) -> list[str]:
    return [
        f"IF {condition} THEN",
        f"    {scaled} := {scaled} * {by};",
        f"    {counter} := {counter} {change};",
        "END_IF;",
    ]
