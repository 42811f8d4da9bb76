"""Stages as C: their constants, and the calls of the core that take one sample through them.

Constants can be in two places. Fixed ones are ``static const`` tables of the file, and numbers
stand where they are used. Held ones are members of a structure, one for each instance, so that they
can be parameters; ``held_by`` then says how that structure is reached, as "model->".
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from textwrap import wrap
from typing import final

from hyst.export.c.core_stage import CoreStage
from hyst.export.c.numbers import Precision, literal, refuse_vanishing, rounded, table


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
    now
        For stages whose constants move: where they begin in the array ``now`` of the step.

    Raises
    ------
    InputError
        If a constant cannot be written in that precision.
    """

    stages: tuple[CoreStage, ...]
    precision: Precision
    held_by: str | None = None
    now: Mapping[int, int] = dataclasses.field(default_factory=dict)

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
        return tuple(sorted({stage.header for stage in self.stages} - {""}))

    def declarations(self) -> str:
        """Give the constants' declarations.

        Fixed ones are written for the head of a file, with the structures that point to them; held
        ones are members of a structure, to be filled from ``constants()``.
        """
        lines: list[str] = []
        for index, stage in enumerate(self.stages):
            if index in self.now:
                continue
            for constant in _constants(stage, index):
                lines += self._declaration(constant)
            if self.held_by is None and _stands_alone(stage):
                lines += _in_lines(f"static const {self._written(stage.structure, stage, index)}")
        return "\n".join(lines) + "\n" if lines else ""

    def calls(
        self,
        signal: str = "u",
        memory: str = "memory",
        only: range | None = None,
        apart: bool = False,
    ) -> str:
        """Give the statements that take one sample through all stages, or some of them.

        Parameters
        ----------
        signal
            The variable that holds the input, and afterwards the output.
        memory
            Points to the first number of memory.
        only
            Places of the stages that are called, one after the other; all if left out.
        apart
            Whether they have a memory of their own, in which the first of them comes first.

        Returns
        -------
        str
            Every stage is given a finite number or is not called; see core/src/guard.c.
        """
        lines: list[str] = []
        offset = 0
        first = _first_inside(self.stages)
        for index, stage in enumerate(self.stages):
            if only is not None and index not in only:
                offset += 0 if apart else stage.state_length
                continue
            lines += [
                f"const hyst_real {_input(self.stages[around], around)} = {signal};"
                for around in first.get(index, ())
            ]
            place = f"{memory} + {offset}" if offset else memory
            lines.append(f"if (hyst_is_finite({signal})) {{")
            lines += [f"    {line}" for line in self._call(stage, index, signal, place)]
            lines.append("}")
            offset += stage.state_length
        return "\n".join(lines) + "\n"

    def call(self, index: int, call: str, signal: str, memory: str) -> str:
        """Give one statement that calls something else with the constants of a stage.

        Parameters
        ----------
        index
            Place of the stage.
        call
            C with the places of a row of ``engine/kinds``.
        signal, memory
            What stands at those of the signal and the memory.
        """
        stage = self.stages[index]
        lines = list(self._call(replace(stage, call=call), index, signal, memory))
        return "\n".join(
            [f"if (hyst_is_finite({signal})) {{", *(f"    {each}" for each in lines), "}"]
        )

    def name(self, index: int) -> str:
        """Give what C calls the structure of a stage."""
        return _name(self.stages[index], index)

    def local(self, index: int) -> str:
        """Give the declaration of the structure of a stage where it is used; "" if in the file."""
        if self.held_by is None:
            return ""
        stage = self.stages[index]
        return "\n".join(_in_lines(f"const {self._written(stage.structure, stage, index)}")) + "\n"

    def _declaration(self, constant: Constant) -> Iterator[str]:
        size = f"[{len(constant.values)}]" if constant.is_table else ""
        if self.held_by is not None:
            yield f"hyst_real {constant.name}{size};"
        elif constant.is_table:
            values = table(constant.values, self.precision, constant.name)
            yield f"static const hyst_real {constant.name}{size} = {values};"

    def _call(self, stage: CoreStage, index: int, signal: str, place: str) -> Iterator[str]:
        structure = self._written(stage.structure, stage, index)
        if not _stands_alone(stage):
            yield from _STATEMENT.findall(structure)
        elif self.held_by is not None or index in self.now:
            yield from _in_lines(f"const {structure}")
        yield self._written(stage.call, stage, index, signal, place)

    def _written(
        self, text: str, stage: CoreStage, index: int, signal: str = "", place: str = ""
    ) -> str:
        """Give the C of a row of ``engine/kinds``, its places filled."""
        fixed = {
            **{name: str(choice) for name, choice in stage.choices.items()},
            "signal": signal,
            "memory": place,
            "model": _name(stage, index),
            "form": stage.form,
            "input": _input(stage, index),
        }
        reference = self._reference(stage, index)

        def fill(found: re.Match[str]) -> str:
            mark, name, share = found.groups()
            if mark == "$":
                return fixed[name] if name in fixed else reference(name)
            size = stage.choices[name] if name in stage.choices else len(stage.tables[name])
            return f"{size // int(share or 1)}u"

        return _PLACE.sub(fill, text)

    def _reference(self, stage: CoreStage, index: int) -> Callable[[str], str]:
        """Give what C writes for a constant of a stage."""
        name = _name(stage, index)
        if index in self.now:
            return _in_array(stage, self.now[index])

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


# What is filled in: $name, #name for a size, #name/5 for a part of it.
_PLACE = re.compile(r"([$#])(\w+)(?:/(\d+))?")
_STATEMENT = re.compile(r"\S[^;]*;")


def _stands_alone(stage: CoreStage) -> bool:
    """Tell whether the structure is one initialised declaration; a union takes statements."""
    return " $model = {" in stage.structure


def _first_inside(stages: tuple[CoreStage, ...]) -> dict[int, list[int]]:
    """Give, by the first stage inside, the stages around it that need its input, outer first."""
    result: dict[int, list[int]] = {}
    firsts: list[int] = []
    for index, stage in enumerate(stages):
        start = index
        for _ in range(stage.inside):
            start = firsts.pop()
        firsts.append(start)
        if "$input" in stage.call:
            result.setdefault(start, []).insert(0, index)
    return result


def values_of(stage: CoreStage) -> tuple[float, ...]:
    """Give all constants of a stage in the order in which an array holds them."""
    return tuple(value for each in _constants(stage, 0) for value in each.values)


def _in_array(stage: CoreStage, first: int) -> Callable[[str], str]:
    """Give what C writes for a constant of a stage whose constants stand in an array."""
    places: dict[str, str] = dict.fromkeys(stage.tables, "NULL")
    for each in _constants(stage, 0):
        places[each.field] = f"now + {first}" if each.is_table else f"now[{first}]"
        first += len(each.values)
    return places.__getitem__


def _input(stage: CoreStage, index: int) -> str:
    return f"{_name(stage, index)}_input"


def _in_lines(statement: str) -> list[str]:
    return wrap(statement, 92, subsequent_indent="    ", break_long_words=False)


def _name(stage: CoreStage, index: int) -> str:
    return f"{stage.kind}_{index + 1}"


def _constants(stage: CoreStage, index: int) -> Iterator[Constant]:
    name = _name(stage, index)
    for field, value in stage.numbers.items():
        yield Constant(f"{name}_{field}", (value,), False, index, field)
    for field, values in stage.tables.items():
        if values:
            yield Constant(f"{name}_{field}", values, True, index, field)
