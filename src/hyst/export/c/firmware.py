"""Export as a C project: sources, self-test, build, description."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from numpy.typing import ArrayLike

from hyst import __version__
from hyst.control.drive_limits import Limits
from hyst.export.c.any_block import any_block
from hyst.export.c.block import Block, Model, described, refuse_unfit
from hyst.export.c.c_sources import WORD_BYTES, header, places, selftest_source, source, vectors
from hyst.export.c.cmake import cmake_file
from hyst.export.c.core_sources import core_files
from hyst.export.c.drive import SAMPLES
from hyst.export.c.drive_options import AUTO, DriveOptions
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.driver_codes import driver_codes
from hyst.export.c.layout import Layout
from hyst.export.c.names import as_c_name
from hyst.export.c.numbers import as_precision
from hyst.export.c.one_file import in_one_file
from hyst.export.c.own_names import with_prefix
from hyst.export.c.readme import readme
from hyst.export.c.selftest import SelfTest
from hyst.export.c.short_test import short_test_source
from hyst.export.c.templating import filled
from hyst.export.folder import FORMAT, write_export
from hyst.export.shared_folder import add_to_folder
from hyst.operators import Driver, ModelDescription


@final
@dataclass(frozen=True)
class CProject:
    """A C project that has been written.

    Parameters
    ----------
    path
        The folder, or the zip.
    files
        What it holds, "/" between folders, sorted.
    name
        Prefix of everything it defines.
    precision
        "double" or "single".
    state_length
        Numbers of memory.
    state_bytes
        Of the state structure.
    saved_bytes
        Of a saved state.
    away_from_double
        Largest difference of the self-test's outputs from those in double: 0 in double.
    readme
        The one of ``files`` that people read.
    test_command
        What a shell compiles and runs the self-test with, in the folder.
    drive
        Limits of the drive, and where they come from.
    history
        The drives it starts after.
    has_start
        Whether ``NAME_init_after`` starts it after others.
    codes
        What is to be told of the driver's codes; "" without a driver.
    """

    path: Path
    files: tuple[str, ...]
    name: str
    precision: str
    state_length: int
    state_bytes: int
    saved_bytes: int
    away_from_double: float
    readme: str
    test_command: str
    drive: DriveRange
    history: tuple[float, ...]
    has_start: bool
    codes: str = ""


def c_project(
    model: Model,
    folder: str | os.PathLike[str],
    *,
    precision: str = "double",
    name: str = "stage",
    force: bool = False,
    description: ModelDescription | None = None,
    despite_verdict: bool = False,
    layout: str = "folder",
    shared_core: bool = False,
    limits: Limits | str | None = AUTO,
    rate_limit: float | None = None,
    history: ArrayLike | None = None,
    history_at: float | None = None,
    driver: Driver | str | None = AUTO,
) -> CProject:
    """Write a model as C99 for firmware, with the core's sources it needs and a self-test.

    Parameters
    ----------
    model
        Any operator; a scheduled model, whose step takes the second signal too; a tracking
        controller, whose step takes y_ref and y; or a joint or scale estimator, which takes in
        samples and gives commands, from the estimate and the memory it has now.
    folder
        What to create: a folder, or a zip if it ends in ``.zip``.
    precision
        "double", for the same bits as in Python, or "single".
    name
        Prefix of files, functions and types, a C identifier.
    force
        Whether an earlier export of that path is replaced, as a whole.
    description
        Names, units and ranges of input and output, for comments and the self-test's range; that of
        the model itself if left out.
    despite_verdict
        Export also a model whose verdict is ``unfit``.
    layout
        "folder", with the core's files in ``core/src/``; "flat", all that is compiled in one
        folder, as an Arduino library has it, and the self-test in ``extras/``; or "single-file",
        with the core's files inside the one source. Flat and single-file exports are added to a
        folder that is there, beside what it holds.
    shared_core
        Whether exports of one folder share one copy of the core in each precision; each is then
        added to a folder that is there.
    limits
        Of the drive, the output of an inverse or the input of a model: ``"auto"`` for its range in
        the record, None or ``"none"`` for none, or lowest and highest. Where it is held at them,
        the memory follows what the actuator really does; see ``hyst.control.LimitedDrive``.
    rate_limit
        The most the drive moves in a second; any if left out.
    history
        What drove the actuator before, in time order, where the start shall be after it: where the
        drive turned is enough, unless time counts.
    history_at
        The second signal of a scheduled model meanwhile, one value, which a history then needs.
    driver
        Table of the drive's converter: the step gives, or takes, its codes too, and the limits are
        volts of codes. ``"auto"`` for that of the description, None or ``"none"`` for none.

    Returns
    -------
    CProject

    Raises
    ------
    InputError
        If the model, the name, the precision or the layout cannot be used, the path exists or holds
        what would be overwritten, the verdict on the model is ``unfit``, the limits are upside down
        or not for this model, or the history is beyond them.
    NotInvertibleError
        If the output of the model in front of an inverse turns back within the limits.

    Examples
    --------
    >>> import tempfile
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5, 0.2], r=[0.1, 0.3], p0=1.0)
    >>> with tempfile.TemporaryDirectory() as parent:
    ...     project = c_project(model.inverse(), f"{parent}/inverse", name="inverse")
    >>> [file for file in project.files if file.endswith(".c") and "core" not in file]
    ['inverse.c', 'inverse_selftest.c', 'inverse_step_response.c']
    """
    as_c_name(name)
    refuse_unfit(model, description, despite_verdict)
    exact = as_precision(precision)
    where = Layout(layout, shared_core, name, exact)
    about = described(model, description)
    codes = driver_codes(driver, about, exact)
    options = DriveOptions(limits, rate_limit, history, codes, history_at)
    block = any_block(model, exact, options, description)
    test = SelfTest.of(block, exact, about)
    files = project_files(block, test, about, where)
    length = max(len(block.start), 1)
    if where.is_alone:
        path = write_export(folder, files, name, force=force)
    else:
        path = add_to_folder(folder, files, name, force=force)
    return CProject(
        path=path,
        files=tuple(sorted(files)),
        name=name,
        precision=exact,
        state_length=len(block.start),
        state_bytes=WORD_BYTES[exact] * (length + 1) + 8,
        saved_bytes=WORD_BYTES[exact] * (length + 1) + 12,
        away_from_double=test.away_from_double,
        readme=where.beside("README.md"),
        test_command=where.places(any(map(where.is_core_source, files)))["test_command"],
        drive=block.drive,
        history=block.history,
        has_start=block.following is not None,
        codes="" if block.codes is None else block.codes.row(),
    )


def project_files(
    block: Block, test: SelfTest, about: ModelDescription, layout: Layout
) -> dict[str, bytes]:
    """Give the files of a project.

    Parameters
    ----------
    block
        What is exported.
    test
        Its self-test.
    about
        What the numbers mean.
    layout
        Name, precision, and where the files lie.

    Returns
    -------
    dict
        Content by path.
    """
    name, precision = layout.name, layout.precision
    common = places(block, name, precision, about)
    head, main = header(block, common), source(block, common, precision)
    needed = core_files(main + head)
    common |= layout.places(any(path.endswith(".c") for path in needed))
    short = layout.own(short_test_source(block, test, common, precision), layout.short_test_folder)
    core = layout.core.files(needed)
    if layout.form == "single-file":
        # Tools and sketches include such sources in one: no name may be that of another's file.
        whole = in_one_file(core, {f"{name}.c": layout.own(main)})
        compiled, short = {f"{name}.c": with_prefix(whole, name)}, with_prefix(short, name)
    else:
        compiled = {f"{name}.c": layout.own(main)}
        compiled |= {layout.core_folder + each: text.decode("ascii") for each, text in core.items()}
    tests = layout.test_folder
    texts = compiled | {
        f"{name}.h": layout.own(head),
        f"{layout.short_test_folder}{name}_step_response.c": short,
        f"{tests}{name}_selftest.c": layout.own(selftest_source(block, common), tests),
        f"{tests}{name}_selftest_vectors.h": layout.own(vectors(block, test, common, precision)),
        layout.beside("LICENSE"): filled("LICENSE", {}),
        layout.beside("README.md"): readme(
            block, common, about, test, any(each.endswith("power.h") for each in needed)
        ),
        "CMakeLists.txt" if layout.is_alone else f"{name}.cmake": cmake_file(
            layout, common, sorted(filter(layout.is_core_source, compiled))
        ),
    }
    files = {path: text.encode("ascii") for path, text in texts.items()}
    return files | {layout.manifest: _manifest(block, layout, files, needed, test)}


def _manifest(
    block: Block,
    layout: Layout,
    files: Mapping[str, bytes],
    needed: Mapping[str, bytes],
    test: SelfTest,
) -> bytes:
    content: dict[str, Any] = {
        "format": FORMAT,
        "version": 2,
        "hyst": __version__,
        "target": "c",
        "name": layout.name,
        "precision": layout.precision,
        "layout": layout.form,
        "model": {"kind": block.kind, "sha256": block.sha256()},
        "drive": block.drive.told(),
        **({} if block.codes is None else {"driver": block.codes.told()}),
        "history": list(block.history),
        **({} if block.history_at is None else {"history_at": block.history_at}),
        "selftest": {"samples": SAMPLES, "away_from_double": test.away_from_double},
        # The core's own files, before their names became those of the copy.
        "core": {
            "prefix": f"{layout.core.prefix}_",
            "shared": layout.shared_core,
            "sources": {path: _sha256(text) for path, text in needed.items()},
        },
        "files": {path: _sha256(files[path]) for path in sorted(files)},
    }
    return (json.dumps(content, indent=2) + "\n").encode()


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
