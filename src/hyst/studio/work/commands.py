"""The session as commands that would repeat it."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass

from hyst.studio.work.choice import Choice
from hyst.studio.work.identifying import FoundModel

TARGETS = {"c": "C", "fmu": "FMU", "mex": "MEX"}
"""What can be exported, and how the page calls it."""


@dataclass(frozen=True)
class Session:
    """What a session came to.

    Parameters
    ----------
    record
        Name of the record's file.
    choice
        How it is read.
    models
        In the order in which they were found.
    chosen
        Name of the model for commands; empty for none.
    method
        By which its command was made; empty where there is none.
    exports
        Targets.
    """

    record: str
    choice: Choice
    models: tuple[FoundModel, ...]
    chosen: str = ""
    method: str = ""
    exports: Sequence[str] = ()

    def commands(self) -> list[str]:
        """Give the commands, to be run in the session's folder."""
        record = f"records/{self.record}"
        reading = self.choice.options()
        table = [] if self.choice.table is None else ["--table", str(self.choice.table)]
        lines = [_line("columns", record, *table), _line("diagnose", record, *reading)]
        for each in self.models:
            fit = ("--family", each.asked, "-o", f"again/{each.name}")
            lines.append(_line("identify", record, *reading, *fit))
        model = f"again/{self.chosen}/model.json"
        if self.method:
            out = ("--method", self.method, "-o", "again/command.csv")
            clip = () if self.method == "noncausal" else ("--outside", "clip")
            lines.append(_line("compensate", model, "reference.csv", "--column", "1", *clip, *out))
        for target in self.exports:
            lines.append(
                _line("export", model, "--inverse", "--target", target, "-o", _out(target))
            )
        return lines


def _out(target: str) -> str:
    return f"again/{target}/stage.fmu" if target == "fmu" else f"again/{target}"


def _line(*words: str) -> str:
    return shlex.join(("hyst", *words))
