"""Models as Rust crates: the bits of Python, built and run with cargo."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from c_builds import Exported, Objects, build_library, same_bits, stepped, wandering
from rust_builds import Crates, cargo, needs_cargo

import hyst
from hyst import InputError, MissingExtraError, PrandtlIshlinskii
from hyst.control import RepetitiveController
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.control.tracking_controller import TrackingController
from hyst.export import c_project, rust
from hyst.export.c.any_block import any_block
from hyst.export.c.block import stepper_of
from hyst.export.c.core_stage import core_stages
from hyst.export.c.drive_options import DriveOptions
from hyst.export.rust_crate.kernel import kernel
from hyst.export.rust_crate.names import rust_name
from hyst.export.translate.exported import program_of
from hyst.online import JointEstimator
from hyst.operators import ModelDescription
from reference.examples import EXAMPLES, PI

SAMPLES = 100_000

# Every kind of stage is in one of these at least, which a test below counts.
KINDS = {
    "chain": "inverse of an actuator that creeps and lags",
    "mixed": "composition mixed",
    "butterfly": "butterfly of friction",
    "direction": "dead-zone by direction",
    "rate": "rate-dependent",
    "linear": "linear",
    "sections": "sections",
    "masing": "masing of a power",
    "element": "memory element",
    "coleman": "coleman-hodgdon",
    "slip": "maxwell-slip",
    "maxwell": "generalized maxwell-slip",
    "envelopes": "two envelopes",
    "shift": "rate shift",
    "planned": "rate-dependent preview",
    "creeping": "creeping plays",
    "late": "delay",
    "ahead": "delay taken back by preview",
    "preisach": "preisach",
    "bouc_wen": "bouc-wen",
    "degrading": "degrading bouc-wen",
    "jiles": "jiles-atherton",
    "lugre": "lugre",
}
# The power function, unions, branches and tables of rows once more, in the other precision.
SINGLE = ("chain", "mixed", "masing", "planned", "preisach", "bouc_wen", "jiles")
INVERSE = PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0).inverse()
LIMITED = LimitedDrive(EXAMPLES["inverse of mpi"], (-2.0, 2.5))
SCHEDULED = hyst.Scheduled(
    [PrandtlIshlinskii([0.5, 0.25 + x], [0.4, 1.5], 0.3) for x in (0.0, 0.1, 0.3)],
    [10.0, 30.0, 50.0],
    "temperature",
    "degC",
)
MOVING = LimitedSchedule(SCHEDULED.inverse(), (-2.0, 2.5))
MORE = {
    "held": LIMITED,
    "controller": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=INVERSE, limits=(-1.7, 1.1)
    ),
    "repetitive": RepetitiveController(
        40, [0.5, 0.2, 0.05], [0.1, -0.2, 0.5, 0.3], 3, 1e-3, EXAMPLES["inverse of mpi"]
    ),
    "scheduled": SCHEDULED,
    "moving": MOVING,
    "estimator": JointEstimator(PI),
}
IN_DOUBLE = [*KINDS, *MORE]


def model_of(name: str) -> hyst.export.c.block.Model:
    return MORE[name] if name in MORE else EXAMPLES[KINDS[name]]


def block_of(name: str, precision: str) -> hyst.export.c.block.Block:
    return any_block(model_of(name), precision, DriveOptions())


@pytest.fixture(scope="module")
def crates(tmp_path_factory: pytest.TempPathFactory) -> Crates:
    models = {name: (model_of(name), "double") for name in IN_DOUBLE}
    models |= {f"{name}_single": (model_of(name), "single") for name in (*SINGLE, "held", "moving")}
    return Crates(tmp_path_factory.mktemp("crates"), models)


def test_every_kind_of_stage_is_among_the_crates() -> None:
    built = {stage.kind for name in KINDS.values() for stage in core_stages(EXAMPLES[name])}
    assert built == {stage.kind for model in EXAMPLES.values() for stage in core_stages(model)}


def _by_code() -> dict[tuple[object, ...], str]:
    """Give one example for each sequence of calls: the others differ in their numbers alone."""
    found: dict[tuple[object, ...], str] = {}
    for name, model in EXAMPLES.items():
        stages = core_stages(model)
        key = tuple((each.kind, each.form, str(each.choices)) for each in stages)
        found.setdefault(key, name)
    return found


@pytest.mark.parametrize("name", _by_code().values())
def test_every_example_is_translated(name: str) -> None:
    block = any_block(EXAMPLES[name], "double", DriveOptions())
    program = program_of(block, "lens", "double", ModelDescription())
    code = kernel(program, "")
    assert "pub fn lens_step(state: &mut LensState, mut u: f64) -> f64 {" in code
    assert "unsafe" not in code
    assert set(program.entries) <= set(program.functions)


def _signals(name: str, precision: str) -> list[np.ndarray]:
    """Input of a crate, in numbers that both precisions have, some of which are none."""
    # Commands planned ahead, and what is learned, take Python a tenth of a millisecond a sample.
    samples = 20_000 if name in ("planned", "estimator") else SAMPLES
    signals = [wandering(samples)]
    if name in ("scheduled", "moving"):
        signals.append(30.0 + 25.0 * np.sin(np.arange(samples) / 501.0))
    elif name in MORE and name != "held":
        signals.append(wandering(samples, seed=8))
    return [each.astype(np.float32).astype(np.float64) for each in signals]


def _same(crates: Crates, name: str, precision: str) -> tuple[bool, int]:
    """Compare output and tell the fault; the estimator is asked for a command every sample."""
    own = name if precision == "double" else f"{name}_single"
    signals = _signals(name, precision)
    y, fault = crates.run(own, *signals)
    step = stepper_of(block_of(name, precision), precision)
    given = (*signals, signals[1]) if name == "estimator" else signals
    return same_bits(y, stepped(step, *given)), fault


@needs_cargo
@pytest.mark.parametrize("name", IN_DOUBLE)
def test_crates_give_the_bits_of_python(name: str, crates: Crates) -> None:
    same, fault = _same(crates, name, "double")
    assert same
    assert fault & 1  # the input has numbers that are none


@needs_cargo
@pytest.mark.parametrize("name", [*SINGLE, "held", "moving"])
def test_crates_in_single_give_the_bits_of_the_core_in_single(name: str, crates: Crates) -> None:
    same, fault = _same(crates, name, "single")
    assert same
    assert fault & 1


@needs_cargo
def test_a_drive_beyond_its_limits_is_held_and_told(crates: Crates) -> None:
    u, fault = crates.run("held", *_signals("held", "double"))
    assert (u.min(), u.max()) == (-2.0, 2.5)
    assert fault & 16  # OUT_OF_RANGE
    library = (crates.folder / "held" / "src" / "lib.rs").read_text()
    assert "pub const U_MIN: Real = -2.0_f64;" in library
    assert "pub const U_MAX: Real = 2.5_f64;" in library
    assert "pub const OUT_OF_RANGE: u32 = 16;" in library


_START = """
use held::{{Held, U_MAX}};

#[test]
fn starts_after_a_history_and_saves_the_bytes_of_c() {{
    let mut block = Held::new();
    block.init_after(&[2.5, -1.5, 0.75]).expect("within the limits");
    let memory: [u64; {count}] = [{memory}];
    for (number, bits) in block.memory().iter().zip(memory) {{
        assert_eq!(number.to_bits(), bits);
    }}
    let mut u = [0.0; 50];
    let reference: Vec<f64> = (0..50).map(|k| 0.03125 * k as f64).collect();
    block.run(&reference, &mut u);
    let bytes: [u8; {size}] = {saved};
    assert_eq!(block.save(), bytes);
    assert!(block.init_after(&[0.0, 1.01 * U_MAX]).is_err());
    assert_eq!(block.save(), Held::new().save());
    assert!(block.init_after(&[f64::NAN]).is_err());
}}
"""


@needs_cargo
def test_a_start_is_that_of_python_and_a_saved_state_that_of_c(
    crates: Crates, tmp_path: Path, objects: Objects
) -> None:
    project = c_project(LIMITED, tmp_path / "out")
    code = Exported(build_library(project.path, objects), project.state_length, project.saved_bytes)
    started = LIMITED.state_after([2.5, -1.5, 0.75])
    state = code.initial_state()
    state.memory[:] = started.tolist()
    state.y_last = 0.75
    code.run(state, 0.03125 * np.arange(50.0))
    saved = code.save(state)
    text = _START.format(
        count=started.size,
        memory=", ".join(hex(each) for each in started.view(np.uint64).tolist()),
        size=len(saved),
        saved=list(saved),
    )
    (crates.folder / "held" / "tests" / "start.rs").write_text(text)
    # Also the crate's own self-test, and what clippy finds.
    told = cargo(crates.folder, "test", "--offline", "-q", "-p", "held")
    assert told.count("test result: ok. 1 passed") >= 2
    assert cargo(crates.folder, "clippy", "--offline", "-q", "-p", "held", "-p", "estimator") == ""


_START_AT = """
use moving::{{Moving, OFF_SCHEDULE}};

#[test]
fn starts_after_a_history_at_a_value() {{
    let mut block = Moving::new();
    block.init_after(&[2.5, -1.5, 0.75], 25.0).expect("within the limits");
    let memory: [u64; {count}] = [{memory}];
    for (number, bits) in block.memory().iter().zip(memory) {{
        assert_eq!(number.to_bits(), bits);
    }}
    assert_eq!(block.fault(), 0);
    assert!(block.init_after(&[0.0], f64::NAN).is_err());
    assert!(block.init_after(&[0.0, 2.6], 25.0).is_err());
    block.init_after(&[0.0], 51.0).expect("the constants are held");
    assert_eq!(block.fault(), OFF_SCHEDULE);
}}
"""


@needs_cargo
def test_a_start_at_a_value_of_the_second_signal(crates: Crates) -> None:
    started = MOVING.state_after([2.5, -1.5, 0.75], 25.0)
    text = _START_AT.format(
        count=started.size, memory=", ".join(hex(each) for each in started.view(np.uint64).tolist())
    )
    (crates.folder / "moving" / "tests" / "start.rs").write_text(text)
    told = cargo(crates.folder, "test", "--offline", "-q", "-p", "moving")
    assert told.count("test result: ok. 1 passed") >= 2
    assert cargo(crates.folder, "clippy", "--offline", "-q", "-p", "moving") == ""


@needs_cargo
@pytest.mark.skipif(shutil.which("nm") is None, reason="nm is not installed")
def test_nothing_in_an_optimised_crate_can_panic(crates: Crates) -> None:
    names = ("held", "planned", "preisach")
    cargo(crates.folder, "build", "--offline", "-q", "--release", *_packages(names))
    for name in names:
        (library,) = (crates.folder / "target" / "release" / "deps").glob(f"lib{name}-*.rlib")
        listed = subprocess.run(["nm", "-C", library], capture_output=True, text=True, check=False)
        assert f"{name}::kernel::" in listed.stdout  # the code is there
        assert "panic" not in listed.stdout


def _packages(names: tuple[str, ...]) -> list[str]:
    return [word for name in names for word in ("-p", name)]


@needs_cargo
def test_a_self_test_can_fail(crates: Crates) -> None:
    vectors = crates.folder / "late" / "tests" / "selftest" / "vectors.rs"
    text = vectors.read_text()
    first = text.split("EXPECTED: [u64; 10000] = [\n")[1].split(",")[0]
    vectors.write_text(text.replace(first, "    0x3ff0000000000001", 1))
    with pytest.raises(AssertionError, match="sample 0"):
        cargo(crates.folder, "test", "--offline", "-q", "-p", "late")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("match", "a word of Rust"),
        ("crate", "a word of Rust"),
        ("alloc", "comes with the compiler"),
        ("option", "would hide that of Rust"),
        ("Lens", "no capitals"),
        ("int", "a word of C or C++"),
    ],
)
def test_names_that_rust_has_are_refused(name: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said.replace("+", r"\+")):
        rust(INVERSE, tmp_path / "out", name=name)
    assert not (tmp_path / "out").exists()


@needs_cargo
def test_crates_are_tested_whatever_they_are_called(tmp_path: Path) -> None:
    names = ["drive", "drive_u", "expected", "k", "u", "vectors", "y"]
    for name in names:
        rust(INVERSE, tmp_path / name, name=name)
    members = ", ".join(f'"{name}"' for name in names)
    (tmp_path / "Cargo.toml").write_text(f'[workspace]\nresolver = "2"\nmembers = [{members}]\n')
    cargo(tmp_path, "check", "--offline", "--tests", "--workspace", "-q")
    readme = (tmp_path / "y" / "README.md").read_text()
    assert "let answer = y.step(0.0);" in readme


def test_words_of_rust_inside_become_raw() -> None:
    assert [rust_name(each) for each in ("loop", "as", "self", "u")] == [
        "r#loop", "r#as", "self_", "u",
    ]  # fmt: skip


def test_the_same_model_gives_the_same_bytes_and_a_manifest(tmp_path: Path) -> None:
    first = rust(INVERSE, tmp_path / "a", name="lens")
    rust(INVERSE, tmp_path / "b", name="lens")
    for file in first.files:
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()
    manifest = json.loads((tmp_path / "a" / "manifest.json").read_text())
    assert manifest["target"] == "rust"
    assert set(manifest["files"]) == set(first.files) - {"manifest.json"}


def test_without_pycparser_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pycparser", None)
    with pytest.raises(MissingExtraError, match=r"hyst\[languages\]"):
        rust(INVERSE, tmp_path / "out")
