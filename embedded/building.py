"""From an exported project to a program for the emulated processor, and what it says of itself."""

from __future__ import annotations

import hashlib
import re
import threading
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from embedded.call_graph import joined, read_call_graph
from embedded.target import COMPILER, MAIN, STRICT, Build, run

FIRMWARE = Path(__file__).resolve().parent / "firmware"

# What an object may ask for: the compiler's own calls to copy and to clear, and, where a processor
# has no instructions for a precision, the compiler's arithmetic.
ALLOWED = re.compile(r"memcpy|memset")
SOFT_FLOAT = re.compile(r"__aeabi_\w+")


@dataclass(frozen=True)
class Sizes:
    """Bytes of code and of constants that initialising and stepping need, and of their stack."""

    code: int
    constants: int
    stack: int


class ObjectStore:
    """Objects that are compiled once, though many projects hold the same sources."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._locks: defaultdict[Path, threading.Lock] = defaultdict(threading.Lock)
        self._lock = threading.Lock()

    def object_of(self, source: Path, build: Build) -> Path:
        """Give the object of a source of the core; equal sources and headers share one."""
        content = [source.name.encode(), source.read_bytes()]
        content += [each.read_bytes() for each in sorted(source.parent.glob("*.h"))]
        key = hashlib.sha256(b"\0".join(content)).hexdigest()[:16]
        made = self._folder / build.name.replace(" ", "-") / f"{source.stem}-{key}.o"
        with self._lock:
            lock = self._locks[made]
        with lock:
            if not made.exists():
                made.parent.mkdir(parents=True, exist_ok=True)
                compile_source(source, made, (), build)
        return made


def compile_source(
    source: Path, made: Path, includes: Iterable[Path], build: Build, *more: str
) -> None:
    """Compile one source, with its call graph beside the object."""
    folders = [f"-I{each}" for each in includes]
    options = [*STRICT, *build.options, "-fcallgraph-info=su", *more, *folders]
    run([COMPILER, *options, "-c", str(source), "-o", str(made)])


@dataclass(frozen=True)
class Objects:
    """The objects of a model: its own and those of the core."""

    own: Path
    core: tuple[Path, ...]

    @property
    def all(self) -> tuple[Path, ...]:
        return (self.own, *self.core)


def compile_model(project: Path, work: Path, store: ObjectStore, build: Build) -> Objects:
    """Compile an exported project."""
    work.mkdir(parents=True, exist_ok=True)
    own = work / "stage.o"
    compile_source(project / "stage.c", own, (), build)
    sources = sorted((project / "core" / "src").glob("*.c"))
    return Objects(own, tuple(store.object_of(each, build) for each in sources))


def link_program(objects: Objects, project: Path, work: Path, build: Build) -> Path:
    """Link a model with the program that measures it; that one is always compiled alike."""
    plain = Build(build.processor, build.precision, MAIN.level)
    includes = (work, FIRMWARE, project)
    own = [work / "measure.o", work / "cortex_m.o"]
    for made in own:
        more = ("-fno-tree-loop-distribute-patterns",)  # its memcpy must not call memcpy
        compile_source(FIRMWARE / f"{made.stem}.c", made, includes, plain, *more)
    program = work / "program.elf"
    script = ["-nostdlib", "-nostartfiles", "-Wl,--gc-sections", "-T", str(FIRMWARE / "mps2.ld")]
    files = [str(each) for each in (*own, *objects.all)]
    run([COMPILER, *build.options, *script, *files, "-lgcc", "-o", str(program)])
    return program


def unexpected_symbols(objects: Objects, build: Build) -> list[str]:
    """Give what the objects ask of libraries beyond what is allowed, and their writable data."""
    listing = run(["arm-none-eabi-nm", "-P", *map(str, objects.all)])
    symbols = [(parts[0], parts[1]) for parts in map(str.split, listing.splitlines()) if parts[1:]]
    defined = {name for name, kind in symbols if kind.isupper() and kind != "U"}
    wanted = {name for name, kind in symbols if kind == "U"} - defined
    unexpected = {name for name in wanted if not ALLOWED.fullmatch(name)}
    if build.processor.lacks_double and build.precision == "double":
        unexpected = {name for name in unexpected if not SOFT_FLOAT.fullmatch(name)}
    return sorted(unexpected | {name for name, kind in symbols if kind in "BbDdCcGgSs"})


def sizes_of(objects: Objects, work: Path, build: Build, roots: tuple[str, ...]) -> Sizes:
    """Measure what is left when only `roots`, the initialisation first, are kept."""
    kept = work / "kept.o"
    keep = ",".join(["-Wl,--gc-sections", "-e", roots[-1], *(f"-u,{each}" for each in roots)])
    files = [str(each) for each in objects.all]
    run([COMPILER, *build.options, "-nostdlib", "-r", keep, *files, "-o", str(kept)])
    listing = run(["arm-none-eabi-size", "-A", str(kept)])
    code = constants = 0
    for parts in map(str.split, listing.splitlines()):
        if parts and parts[0].startswith(".text"):
            code += int(parts[1])
        elif parts and parts[0].startswith(".rodata"):
            constants += int(parts[1])
    graphs = (read_call_graph(each.with_suffix(".ci").read_text()) for each in objects.all)
    calls = joined(graphs)
    return Sizes(code, constants, max(calls.deepest(each) for each in roots[1:]))
