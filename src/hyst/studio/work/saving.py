"""A session as a folder that the command line reads."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np

from hyst._files import replacing
from hyst.errors import HystError, InputError
from hyst.export import c_project, fmu, inverse_of, mex
from hyst.identification import Identified
from hyst.io import write_columns
from hyst.report import dynamics_sections, write_report
from hyst.studio.work.commands import TARGETS, Session
from hyst.studio.work.folder import MARK
from hyst.studio.work.following import command_for
from hyst.studio.work.identifying import FoundModel
from hyst.studio.work.jobs import Place, Saved
from hyst.studio.work.measuring import record_of
from hyst.studio.work.reference import Reference
from hyst.studio.work.sentences import sentence_of


def write_session(place: Place, session: Session, reference: Reference | None) -> Saved:
    """Write a session.

    Parameters
    ----------
    place, session, reference
        Where and what.

    Returns
    -------
    Saved
        Also where code could not be exported, which it says.

    Raises
    ------
    InputError
        If the folder is there and is no session.
    """
    folder = place.folder
    _require_own(folder)
    (folder / "records").mkdir(parents=True, exist_ok=True)
    copied = folder / "records" / session.record
    if not copied.exists() or not copied.samefile(place.record):
        shutil.copyfile(place.record, copied)
    record = record_of(place.record, session.choice)
    for each in session.models:
        found = each.result()
        sections = dynamics_sections(found)
        write_report(
            found, record, (), folder / "models" / each.name,
            sources=[str(Path("records") / session.record)], sections=sections,
        )  # fmt: skip
    if reference is not None and session.method:
        _write_command(folder, _chosen(session).result(), reference)
    exports, refusals = _exported(session, folder)
    session = replace(session, exports=exports)
    with replacing(folder / MARK) as temporary:
        lines = ["#!/bin/sh", "# Repeats this session; run it in this folder.", "set -e"]
        temporary.write_text("\n".join([*lines, *session.commands()]) + "\n", encoding="utf-8")
    written = sorted(each for each in folder.rglob("*") if each.is_file())
    return Saved(tuple(each.relative_to(folder).as_posix() for each in written), refusals)


def _exported(session: Session, folder: Path) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Write the code that can be written, and say of the other why not."""
    written, refusals = [], []
    for target in session.exports:
        try:
            _export(_chosen(session), target, folder / target)
            written.append(target)
        except (HystError, OSError) as refusal:
            refusals.append(f"{TARGETS[target]} was not written: {sentence_of(refusal)}")
    return tuple(written), tuple(refusals)


def _require_own(folder: Path) -> None:
    if folder.exists() and not (folder / MARK).is_file() and any(folder.iterdir()):
        raise InputError(
            f"{folder.name} is there and holds no session of the studio; give another name"
        )
    links = [each for each in folder.rglob("*") if each.is_symlink()]
    if links:
        raise InputError(
            f"{folder.name} holds the link {links[0].name}, which may lead anywhere; give another "
            "name, or take it away"
        )


def _chosen(session: Session) -> FoundModel:
    return next(each for each in session.models if each.name == session.chosen)


def _write_command(folder: Path, found: Identified, reference: Reference) -> None:
    time, y_ref = reference.sampled(found.model.dt)
    done, _ = command_for(found, y_ref)
    about = found.description
    u, y = (
        f"{name} [{unit}]" if unit else name
        for name, unit in ((about.input_name or "u", about.input_unit),
                           (about.output_name or "y", about.output_unit))
    )  # fmt: skip
    _write(folder / "reference.csv", ["time [s]", y], [time, y_ref])
    headers = ["time [s]", f"reference {y}", u, f"predicted {y}"]
    _write(folder / "command.csv", headers, [time, y_ref, done.u, done.y_predicted])


def _write(path: Path, headers: list[str], columns: list[np.ndarray]) -> None:
    with replacing(path) as temporary:
        write_columns(temporary, headers, columns)


def _export(model: FoundModel, target: str, folder: Path) -> None:
    found = model.result()
    inverse = inverse_of(found.model)
    if target == "c":
        c_project(inverse, folder, force=True)
    elif target == "fmu":
        folder.mkdir(parents=True, exist_ok=True)
        fmu(inverse, folder / "stage.fmu", force=True)
    else:
        mex(inverse, folder, force=True)
