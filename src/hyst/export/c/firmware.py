"""Export as a C project: sources, self-test, build, description."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from numpy.typing import ArrayLike

from hyst import __version__
from hyst.control.drive_limits import Limits
from hyst.export.c.any_block import any_block
from hyst.export.c.block import Block, Model, described, refuse_unfit
from hyst.export.c.c_sources import WORD_BYTES, header, places, selftest_source, source, vectors
from hyst.export.c.core_sources import core_files
from hyst.export.c.drive import SAMPLES
from hyst.export.c.drive_options import AUTO, DriveOptions
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.driver_codes import driver_codes
from hyst.export.c.flat import flattened
from hyst.export.c.names import as_c_name
from hyst.export.c.numbers import Precision, as_precision
from hyst.export.c.readme import readme
from hyst.export.c.selftest import SelfTest
from hyst.export.c.short_test import short_test_source
from hyst.export.c.templating import filled
from hyst.export.folder import FORMAT, MANIFEST, write_export
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
    flat: bool = False,
    limits: Limits | str | None = AUTO,
    rate_limit: float | None = None,
    history: ArrayLike | None = None,
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
    flat
        Whether all code lies in one folder and needs no path of includes, as an Arduino library
        does; the self-test is then in a folder of its own.
    limits
        Of the drive, the output of an inverse or the input of a model: ``"auto"`` for its range in
        the record, None or ``"none"`` for none, or lowest and highest. Where it is held at them,
        the memory follows what the actuator really does; see ``hyst.control.LimitedDrive``.
    rate_limit
        The most the drive moves in a second; any if left out.
    history
        What drove the actuator before, in time order, where the start shall be after it: where the
        drive turned is enough, unless time counts.
    driver
        Table of the drive's converter: the step gives, or takes, its codes too, and the limits are
        volts of codes. ``"auto"`` for that of the description, None or ``"none"`` for none.

    Returns
    -------
    CProject

    Raises
    ------
    InputError
        If the model, the name or the precision cannot be used, the path exists, the verdict on the
        model is ``unfit``, the limits are upside down or not for this model, or the history is
        beyond them.
    NotInvertibleError
        If the output of the model in front of an inverse turns back within the limits.

    Examples
    --------
    >>> import tempfile
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5, 0.2], r=[0.1, 0.3], p0=1.0)
    >>> with tempfile.TemporaryDirectory() as parent:
    ...     project = c_project(model.inverse(), f"{parent}/inverse", name="inverse")
    >>> [file for file in project.files if file.endswith(".c")]
    ['core/src/prandtl_ishlinskii.c', 'inverse.c', 'selftest.c']
    """
    as_c_name(name)
    refuse_unfit(model, description, despite_verdict)
    exact = as_precision(precision)
    about = described(model, description)
    codes = driver_codes(driver, about, exact)
    options = DriveOptions(limits, rate_limit, history, codes)
    block = any_block(model, exact, options, description)
    test = SelfTest.of(block, exact, about)
    files = project_files(block, test, name, exact, about, flat)
    length = max(len(block.start), 1)
    path = write_export(folder, files, name, force=force)
    return CProject(
        path=path,
        files=tuple(sorted(files)),
        name=name,
        precision=exact,
        state_length=len(block.start),
        state_bytes=WORD_BYTES[exact] * (length + 1) + 8,
        saved_bytes=WORD_BYTES[exact] * (length + 1) + 12,
        away_from_double=test.away_from_double,
        drive=block.drive,
        history=block.history,
        has_start=block.following is not None,
        codes="" if block.codes is None else block.codes.row(),
    )


def project_files(
    block: Block,
    test: SelfTest,
    name: str,
    precision: Precision,
    about: ModelDescription,
    flat: bool = False,
) -> dict[str, bytes]:
    """Give the files of a project.

    Parameters
    ----------
    block
        What is exported.
    test
        Its self-test.
    name
        The prefix, checked.
    precision
        Of the target.
    about
        What the numbers mean.
    flat
        Whether all code lies in one folder.

    Returns
    -------
    dict
        Content by path.
    """
    common = places(block, name, precision, about)
    head, main = header(block, common), source(block, common, precision)
    core = {f"core/{path}": text for path, text in core_files(main + head).items()}
    own = [f"{name}.c", f"{name}_step_response.c"]
    sources = [*own, *(path for path in core if path.endswith(".c"))]
    cmake = {
        "sources": "\n".join(f"  {each}" for each in sources),
        "definitions": f"target_compile_definitions({name} PUBLIC HYST_SINGLE)\n"
        if precision == "single"
        else "",
    }
    texts = {
        f"{name}.h": head,
        f"{name}.c": main,
        f"{name}_step_response.c": short_test_source(block, test, common, precision),
        "selftest.c": selftest_source(block, common),
        "selftest_vectors.h": vectors(block, test, common, precision),
        "CMakeLists.txt": filled("CMakeLists.txt", common | cmake),
        "LICENSE": filled("LICENSE", {}),
        "README.md": readme(
            block,
            common,
            about,
            test,
            _commands(common, sources, flat),
            any(path.endswith("power.h") for path in core),
        ),
    }
    files = {path: text.encode("ascii") for path, text in texts.items()} | core
    files = flattened(files, name) if flat else files
    return files | {MANIFEST: _manifest(block, name, precision, files, test)}


def _commands(common: dict[str, str], sources: list[str], flat: bool) -> dict[str, str]:
    """Give what the README tells of compiling: options and files, and what goes elsewhere."""
    name, define = common["name"], common["define"]
    if flat:
        return {
            "build_test": f"{define}*.c selftest/*.c",
            "build_example": f"{define}*.c",
            "own_files": "The `.c` and `.h` files of this folder are all it takes",
        }
    own, core = f"{name}.c {name}_step_response.c", " core/src/*.c" if len(sources) > 2 else ""
    paths = f"{define}-I. -Icore/include "
    return {
        "build_test": f"{paths}selftest.c {own}{core}",
        "build_example": f"{paths}example.c {own}{core}",
        "own_files": f"`{name}.c`, `{name}.h` and `core/` are all it takes",
    }


def _manifest(
    block: Block, name: str, precision: str, files: dict[str, bytes], test: SelfTest
) -> bytes:
    content: dict[str, Any] = {
        "format": FORMAT,
        "version": 1,
        "hyst": __version__,
        "target": "c",
        "name": name,
        "precision": precision,
        "model": {"kind": block.kind, "sha256": block.sha256()},
        "drive": block.drive.told(),
        **({} if block.codes is None else {"driver": block.codes.told()}),
        "history": list(block.history),
        "selftest": {"samples": SAMPLES, "away_from_double": test.away_from_double},
        "files": {path: hashlib.sha256(files[path]).hexdigest() for path in sorted(files)},
    }
    return (json.dumps(content, indent=2) + "\n").encode()
