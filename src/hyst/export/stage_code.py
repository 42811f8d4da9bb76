"""Stages as C: their constants, and the calls of the core that take one sample through them.

Constants can be in two places. Fixed ones are ``static const`` tables of the file, and numbers
stand where they are used. Held ones are members of a structure, one for each instance, so that they
can be parameters; ``held_by`` then says how that structure is reached, as "model->".
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from textwrap import wrap
from typing import final

from hyst.export.c.numbers import Precision, literal, refuse_vanishing, rounded, table
from hyst.export.stages import Stage


@final
@dataclass(frozen=True)
class Constant:
    """A constant of one stage by its C name.

    Parameters
    ----------
    name
        Unique in the chain: kind and place of the stage, from 1, and its place in the structure.
    values
        In double, in C's order; one for a number.
    is_table
        Whether it is an array.
    stage
        Place of its stage, from 0.
    field
        Its place in the core's structure.
    """

    name: str
    values: tuple[float, ...]
    is_table: bool
    stage: int
    field: str


@final
@dataclass(frozen=True)
class StageCode:
    """The C of a chain of stages.

    Parameters
    ----------
    stages
        In the order the signal passes them.
    precision
        Of the target.
    held_by
        How the structure that holds the constants is reached, as "model->"; None for constants
        that are fixed in the file.

    Raises
    ------
    InputError
        If a constant cannot be written in that precision.
    """

    stages: tuple[Stage, ...]
    precision: Precision
    held_by: str | None = None

    def __post_init__(self) -> None:
        for constant in self.constants():
            for value in constant.values:
                rounded(value, self.precision, constant.name)
            refuse_vanishing(constant.values, self.precision, constant.name)

    def constants(self) -> tuple[Constant, ...]:
        """Give all constants, stage after stage; arrays without entries are left out."""
        return tuple(
            constant
            for index, stage in enumerate(self.stages)
            for constant in _constants(stage, index)
        )

    @property
    def state_length(self) -> int:
        """Numbers of memory of all stages."""
        return sum(stage.state_length for stage in self.stages)

    def headers(self) -> tuple[str, ...]:
        """Give the headers of the core that the calls need, sorted."""
        return tuple(sorted({_HEADERS[stage.kind] for stage in self.stages} - {""}))

    def declarations(self) -> str:
        """Give the constants' declarations.

        Fixed ones are written for the head of a file, with the structures that point to them; held
        ones are members of a structure, to be filled from ``constants()``.
        """
        lines: list[str] = []
        for index, stage in enumerate(self.stages):
            for constant in _constants(stage, index):
                lines += self._declaration(constant)
            if self.held_by is None and stage.kind in _POSITIONAL:
                lines += _in_lines(f"static const {self._structure(stage, index)}")
        return "\n".join(lines) + "\n" if lines else ""

    def calls(self, signal: str = "u", memory: str = "memory") -> str:
        """Give the statements that take one sample through all stages.

        Parameters
        ----------
        signal
            The variable that holds the input, and afterwards the output.
        memory
            Points to the first number of memory.

        Returns
        -------
        str
            Every stage is given a finite number or is not called; see core/src/guard.c.
        """
        lines: list[str] = []
        offset = 0
        for index, stage in enumerate(self.stages):
            place = f"{memory} + {offset}" if offset else memory
            lines.append(f"if (hyst_is_finite({signal})) {{")
            lines += [f"    {line}" for line in self._call(stage, index, signal, place)]
            lines.append("}")
            offset += stage.state_length
        return "\n".join(lines) + "\n"

    def _declaration(self, constant: Constant) -> Iterator[str]:
        size = f"[{len(constant.values)}]" if constant.is_table else ""
        if self.held_by is not None:
            yield f"hyst_real {constant.name}{size};"
        elif constant.is_table:
            values = table(constant.values, self.precision, constant.name)
            yield f"static const hyst_real {constant.name}{size} = {values};"

    def _call(self, stage: Stage, index: int, signal: str, place: str) -> Iterator[str]:
        name = _name(stage, index)
        reference = self._reference(stage, index)
        if stage.kind == "affine":
            gain, offset = reference("gain"), reference("offset")
            yield f"{signal} = {gain} * {signal} + {offset};"
            return
        if stage.kind in ("play", "stop"):
            yield f"{signal} = hyst_{stage.kind}_step({reference('r')}, {place}, {signal});"
            return
        if stage.kind == "masing":
            yield from _masing(stage, name, reference)
        elif self.held_by is not None:
            yield from _in_lines(f"const {self._structure(stage, index)}")
        if stage.kind == "tracking_controller":
            yield f"{signal} = hyst_tracking_controller_linear(&{name}, {place}, y_ref, y);"
            return
        state = "" if stage.kind == "dead_zone" else f"{place}, "
        yield f"{signal} = hyst_{stage.kind}_step(&{name}, {state}{signal});"

    def _structure(self, stage: Stage, index: int) -> str:
        c_type, initialiser = _POSITIONAL[stage.kind]
        values = initialiser(stage, self._reference(stage, index))
        return f"{c_type} {_name(stage, index)} = {values};"

    def _reference(self, stage: Stage, index: int) -> Callable[[str], str]:
        """Give what C writes for a constant of a stage."""
        name = _name(stage, index)

        def reference(field: str) -> str:
            if field in stage.tables and not stage.tables[field]:
                return "NULL"
            if self.held_by is not None:
                return f"{self.held_by}{name}_{field}"
            if field in stage.tables:
                return f"{name}_{field}"
            text = literal(stage.numbers[field], self.precision, f"{name}_{field}")
            return f"({text})" if text.startswith("-") else text

        return reference


def _in_lines(statement: str) -> list[str]:
    return wrap(statement, 92, subsequent_indent="    ", break_long_words=False)


def _name(stage: Stage, index: int) -> str:
    return f"{stage.kind}_{index + 1}"


def _constants(stage: Stage, index: int) -> Iterator[Constant]:
    name = _name(stage, index)
    for field, value in stage.numbers.items():
        yield Constant(f"{name}_{field}", (value,), False, index, field)
    for field, values in stage.tables.items():
        if values:
            yield Constant(f"{name}_{field}", values, True, index, field)


Reference = Callable[[str], str]


def _size(stage: Stage, field: str) -> str:
    return f"{len(stage.tables[field])}u"


def _dead_zone(stage: Stage, of: Reference) -> str:
    return f"{{{_size(stage, 'weight')}, {of('weight')}, {of('threshold')}}}"


def _pi(stage: Stage, of: Reference) -> str:
    return f"{{{_size(stage, 'p')}, {of('p0')}, {of('p')}, {of('r')}}}"


def _rate_dependent_pi(stage: Stage, of: Reference) -> str:
    powers = f"{_size(stage, 'power')}, {of('power')}"
    return f"{{{_pi(stage, of)}, {of('growth')}, {powers}, {_dead_zone(stage, of)}}}"


def _state_space(stage: Stage, of: Reference) -> str:
    sizes = f"{_size(stage, 'b')}, {stage.choices['delay']}u"
    return f"{{{sizes}, {of('a')}, {of('b')}, {of('c')}, {of('d')}}}"


def _tracking_controller(stage: Stage, of: Reference) -> str:
    constants = f"{of('a')}, {of('b')}, {of('c')}, {{{of('d_y_ref')}, {of('d_y')}}}"
    # Without an inverse: its stages are called one by one, after the linear part.
    return f"{{{_size(stage, 'c')}, {constants}, {{0u, NULL}}}}"


def _sections(stage: Stage, of: Reference) -> str:
    return f"{{{len(stage.tables['coefficient']) // 5}u, {of('coefficient')}}}"


def _memory_element(stage: Stage, of: Reference) -> str:
    function = f"{{{stage.form}, {_size(stage, 'value')}, {of('knot')}, {of('value')}}}"
    switches = ", ".join(str(stage.choices[key]) for key in ("inverse", "absolute", "is_reset"))
    return f"{{{function}, {switches}, {of('reset_to')}, {of('dt')}}}"


def _masing(stage: Stage, name: str, of: Reference) -> Iterator[str]:
    """Fill the structure member by member: it holds a union, which C++ cannot initialise."""
    yield f"hyst_masing {name};"
    yield f"{name}.curve.kind = {stage.form};"
    member = _CURVE_MEMBERS[stage.form]
    for table_name, values in stage.tables.items():
        if table_name in ("knot", "coefficient"):
            yield f"{name}.curve.as.{member}.count = {len(values)}u;"
        yield f"{name}.curve.as.{member}.{table_name} = {of(table_name)};"
    for number in stage.numbers:
        if number != "dead_band":
            yield f"{name}.curve.as.{member}.{number} = {of(number)};"
    for choice in ("inverse", "last_reversal"):
        yield f"{name}.{choice} = {stage.choices[choice]};"
    yield f"{name}.depth = {stage.choices['depth']}u;"
    yield f"{name}.dead_band = {of('dead_band')};"


_CURVE_MEMBERS = {
    "HYST_POWER_LAW": "power_law",
    "HYST_PLAYS": "pieces",
    "HYST_POLYNOMIAL": "polynomial",
}

# Type and initialiser, in the order of the members in core/include/hyst.
_POSITIONAL: dict[str, tuple[str, Callable[[Stage, Reference], str]]] = {
    "dead_zone": ("hyst_dead_zone", _dead_zone),
    "direction_dead_zone": ("hyst_dead_zone", _dead_zone),
    "pi": ("hyst_pi", _pi),
    "rate_dependent_pi": ("hyst_rate_dependent_pi", _rate_dependent_pi),
    "state_space": ("hyst_state_space", _state_space),
    "sections": ("hyst_sections", _sections),
    "tracking_controller": ("hyst_tracking_controller", _tracking_controller),
    "memory_element": ("hyst_memory_element", _memory_element),
}

_HEADERS = {
    "affine": "",
    "play": "hyst/play.h",
    "stop": "hyst/play.h",
    "dead_zone": "hyst/dead_zone.h",
    "direction_dead_zone": "hyst/dead_zone.h",
    "pi": "hyst/prandtl_ishlinskii.h",
    "rate_dependent_pi": "hyst/rate_dependent_prandtl_ishlinskii.h",
    "state_space": "hyst/linear_dynamics.h",
    "sections": "hyst/linear_dynamics.h",
    "masing": "hyst/masing.h",
    "tracking_controller": "hyst/tracking_controller.h",
    "memory_element": "hyst/memory_element.h",
}
