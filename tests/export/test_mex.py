"""A MEX function gives the numbers of Python, bit for bit, in Octave."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from fmu_runs import (
    CONTROLLER,
    INVERSE_MPI,
    LIMITED_CONTROLLER,
    SHAPES,
    estimated,
    estimation,
    rough_signal,
)

import hyst
from hyst.operators import ModelDescription
from reference.examples import PI

needs_octave = pytest.mark.skipif(
    shutil.which("mkoctfile") is None or shutil.which("octave-cli") is None,
    reason="Octave and its mkoctfile are not installed",
)
N = 300
READ = "fid = fopen('{0}.bin'); {0} = fread(fid, Inf, 'double'); fclose(fid);\n"
WRITE = "fid = fopen('{0}.bin', 'w'); fwrite(fid, {0}, 'double'); fclose(fid);\n"


def compiled(written: hyst.export.MexFolder, *options: str) -> Path:
    command = ["mkoctfile", "--mex", *options, f"{written.name}_mex.c"]
    done = subprocess.run(command, cwd=written.path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""  # warnings
    return written.path


def octave(folder: Path, program: str) -> str:
    """What a program prints, run in a folder."""
    (folder / "program.m").write_text(program + "\ndisp('done')\n")
    done = subprocess.run(
        ["octave-cli", "--quiet", "--norc", "program.m"],
        cwd=folder, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.stdout.endswith("done\n"), done.stdout + done.stderr
    return done.stdout.removesuffix("done\n")


def stepped(model: hyst.Operator, u: np.ndarray) -> np.ndarray:
    step = model.stepper()
    return np.array([step(value) for value in u.tolist()])


@needs_octave
@pytest.mark.parametrize("part", range(4))
def test_every_kind_of_model(part: int, tmp_path: Path) -> None:
    """One Octave for several: it takes longer to start than to run."""
    models = dict(list(SHAPES.items())[part::4])
    u = rough_signal(N, size=2.0)
    u.tofile(tmp_path / "u.bin")
    program = READ.format("u")
    for i, model in enumerate(models.values()):
        name = f"model_{i}"
        folder = compiled(
            hyst.export.mex(model, tmp_path / name, name=name), "-Wall", "-Wextra", "-O0"
        )
        program += f"addpath('{folder}'); y = {name}(u);\n"
        program += WRITE.format("y").replace("y.bin", f"{name}.bin")
    octave(tmp_path, program)
    for i, (kind, model) in enumerate(models.items()):
        y = (tmp_path / f"model_{i}.bin").read_bytes()
        assert y == stepped(model, u).tobytes(), kind


@pytest.fixture(scope="module")
def inverse(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("mex") / "inverse"
    compiled(hyst.export.mex(INVERSE_MPI, folder, name="lens"))
    return folder


@pytest.fixture
def run(inverse: Path) -> Callable[[str], str]:
    return lambda program: octave(inverse, program)


@needs_octave
def test_records_steps_and_states(inverse: Path, run: Callable[[str], str]) -> None:
    u = rough_signal(N)
    u.tofile(inverse / "u.bin")
    program = """
    row = lens(u'); column = lens(u);
    assert(size(row), [1 numel(u)]); assert(size(column), [numel(u) 1]); assert(row', column);
    [first, state] = lens(u(1:100));
    [second, state] = lens(u(101:200), state);
    third = lens(u(201:end), state);
    assert(class(state), 'uint8');
    again = lens(u(1), []);
    object = lens();
    stepped = zeros(size(u));
    for k = 1:150, stepped(k) = object.step(u(k)); end
    saved = object.state;
    save('-binary', 'state.dat', 'saved');
    stepped(151:end) = object.step(u(151:end));
    other = lens_stepper();
    other.state = load('state.dat').saved;
    loaded = zeros(150, 1);
    for k = 151:300, loaded(k - 150) = other.step(u(k)); end
    object.reset();
    anew = object.step(u(1));
    same = anew == again && anew == column(1) && isequal(loaded, stepped(151:end));
    assert(same);
    joined = [first; second; third];
    """
    wanted = ("column", "joined", "stepped")
    run(READ.format("u") + program + "".join(map(WRITE.format, wanted)))
    for name in wanted:
        assert (inverse / f"{name}.bin").read_bytes() == INVERSE_MPI(u).tobytes(), name


@needs_octave
def test_a_step_that_is_not_finite_is_held(run: Callable[[str], str]) -> None:
    said = run("""
    object = lens(); twin = lens();
    y = object.step([1 2]); twin.step([1 2]);
    disp(isequal(object.step([NaN Inf -Inf]), [y(2) y(2) y(2)]))
    disp([object.fault(), twin.fault()])
    disp(isequal(object.step(0.5), twin.step(0.5)))
    disp(object.fault())
    object.clear_fault();
    disp(object.fault())
    """)
    assert said.split() == ["1", "1", "0", "1", "1", "0"]


@needs_octave
def test_a_controller_with_two_inputs(tmp_path: Path) -> None:
    folder = compiled(hyst.export.mex(CONTROLLER, tmp_path / "loop", name="loop"))
    y_ref, y = rough_signal(N, 1), rough_signal(N, 2)
    y_ref.tofile(folder / "y_ref.bin")
    y.tofile(folder / "y.bin")
    program = """
    u = loop(y_ref, y); object = loop();
    assert(object.step(y_ref(1), y(1)), u(1));
    [~, state] = loop(y_ref(1:9), y(1:9));
    assert(loop(y_ref(10:end), y(10:end), state), u(10:end));
    try, loop(y_ref), catch e, disp(e.message), end
    try, loop(y_ref, y(2:end)), catch e, disp(e.message), end
    """
    said = octave(folder, READ.format("y_ref") + READ.format("y") + program + WRITE.format("u"))
    assert (folder / "u.bin").read_bytes() == CONTROLLER.run(y_ref, y)[0].tobytes()
    assert "a signal is missing" in said
    assert "the signals differ in length" in said


@needs_octave
def test_a_controller_with_limits(tmp_path: Path) -> None:
    """To meet limits is no bad sample: a record is answered, and ``limited`` tells."""
    folder = compiled(hyst.export.mex(LIMITED_CONTROLLER, tmp_path / "loop", name="loop"))
    y_ref, y = rough_signal(N, 1), rough_signal(N, 2)
    y_ref.tofile(folder / "y_ref.bin")
    y.tofile(folder / "y.bin")
    program = """
    [u, state] = loop(y_ref, y); object = loop();
    disp(object.limited());
    object.step(y_ref, y); disp(object.limited()); disp(object.fault());
    assert(object.state(13:end - 4), state(13:end - 4));
    object.step(NaN, 0); disp(object.fault());
    object.clear_fault(); disp(object.limited());
    try, loop([0 NaN], [0 0]), catch e, disp(e.message), end
    """
    said = octave(folder, READ.format("y_ref") + READ.format("y") + program + WRITE.format("u"))
    assert (folder / "u.bin").read_bytes() == LIMITED_CONTROLLER.run(y_ref, y)[0].tobytes()
    assert said.splitlines()[:5] == ["0", "1", "0", "1", "0"]
    assert "sample 2 is not finite" in said


@needs_octave
def test_an_estimator(tmp_path: Path) -> None:
    estimator, *signals = estimation()
    folder = compiled(hyst.export.mex(estimator, tmp_path / "adapt", name="adapt"))
    reading = ""
    for name, signal in zip(("u", "y", "y_ref"), signals, strict=True):
        signal.tofile(folder / f"{name}.bin")
        reading += READ.format(name)
    program = """
    object = adapt();
    commands = object.step(u, y, y_ref);
    theta = object.estimate();
    disp(object.fault())
    [~, state] = adapt(u(1:70), y(1:70), y_ref(1:70));
    try, adapt(u, y, y_ref), catch e, disp(e.message), end
    try, adapt(u(1:5), y(1:5), NaN(5, 1)), catch e, disp(e.message), end
    """
    said = octave(folder, reading + program + WRITE.format("commands") + WRITE.format("theta"))
    assert (folder / "commands.bin").read_bytes() == estimated(estimator, *signals).tobytes()
    assert (folder / "theta.bin").read_bytes() == estimator.parameters.tobytes()
    lines = said.splitlines()
    assert lines[0] == "1"
    assert "sample 71 is not finite" in lines[1]
    assert "sample 1 is not finite" in lines[2]


BAD = {
    "lens([1 NaN 3])": ("hyst:input", "sample 2 is not finite"),
    "lens([1; 2; -Inf])": ("hyst:input", "sample 3 is not finite"),
    "lens(1 + 2i)": ("hyst:input", "u is complex"),
    "lens([])": ("hyst:input", "u is empty"),
    "lens(zeros(1, 0))": ("hyst:input", "u is empty"),
    "lens(single(1))": ("hyst:input", "u is not of class double"),
    "lens(int32(1))": ("hyst:input", "u is not of class double"),
    "lens('text')": ("hyst:input", "u is not of class double"),
    "lens({1})": ("hyst:input", "u is not of class double"),
    "lens(true)": ("hyst:input", "u is not of class double"),
    "lens(sparse(1))": ("hyst:input", "u is sparse"),
    "lens(ones(2))": ("hyst:input", "u is a matrix"),
    "lens(ones(1, 1, 2))": ("hyst:input", "u is a matrix"),
    "lens(1, 5)": ("hyst:state", "the state is damaged"),
    "lens(1, uint8(1:20))": ("hyst:state", "the state is damaged"),
    "lens(1, damaged)": ("hyst:state", "the state is damaged"),
    "lens_mex()": ("hyst:call", "not one it knows"),
    "lens_mex(1)": ("hyst:call", "not one it knows"),
    "lens_mex('strange', state)": ("hyst:call", "not one it knows"),
    "lens_mex('run', state)": ("hyst:call", "not one it knows"),
    "lens_mex('start', state)": ("hyst:call", "not one it knows"),
    "lens_mex('a command far too long', state)": ("hyst:call", "not one it knows"),
}


@needs_octave
def test_calls_that_are_wrong(run: Callable[[str], str]) -> None:
    program = "[~, state] = lens(1); damaged = state; damaged(30) = bitxor(damaged(30), 1);\n"
    for call in BAD:
        program += (
            f"try, {call}; disp('nothing'), catch e, disp([e.identifier ' ' e.message]), end\n"
        )
    lines = run(program).splitlines()
    assert len(lines) == len(BAD)
    for line, (call, (identifier, part)) in zip(lines, BAD.items(), strict=True):
        assert line.startswith(identifier), call
        assert part in line, call
        assert line.endswith("."), call


@needs_octave
def test_compilers_that_would_fuse_products_and_sums(tmp_path: Path) -> None:
    written = hyst.export.mex(INVERSE_MPI, tmp_path / "fused", name="fused")
    compiled(written, "-march=native", "-ffp-contract=fast")
    u = rough_signal(N)
    u.tofile(written.path / "u.bin")
    octave(written.path, READ.format("u") + "y = fused(u);\n" + WRITE.format("y"))
    assert (written.path / "y.bin").read_bytes() == INVERSE_MPI(u).tobytes()


def test_the_c_file_stands_alone(tmp_path: Path) -> None:
    about = ModelDescription('"*/ #error', "% \\ <b>", "V\n%{", "\N{MICRO SIGN}m")
    written = hyst.export.mex(INVERSE_MPI, tmp_path / "a", description=about)
    assert written.files == (
        "README.md", "manifest.json", "stage.m", "stage_mex.c", "stage_stepper.m",
    )  # fmt: skip
    text = (written.path / "stage_mex.c").read_text(encoding="ascii")
    own = [line for line in text.splitlines() if line.lstrip().startswith('#include "')]
    assert own == ['#include "mex.h"']
    assert "Permission is hereby granted" in text
    assert "#error\n" not in text.replace('#error "', "")
    core = Path(__file__).resolve().parents[2] / "core"
    for line in (core / "src/prandtl_ishlinskii.c").read_text().splitlines():
        renamed = line.replace("hyst_", "stage_core_").replace("HYST_", "STAGE_CORE_")
        assert renamed in text or line.startswith("#include")


# What MATLAB documents of its C matrix API, as far as it is called, in the form for interleaved
# complex numbers. MATLAB has more; a call of anything else does not compile.
INTERLEAVED_MEX_H = """
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#define MX_HAS_INTERLEAVED_COMPLEX 1
typedef struct mxArray_tag mxArray;
typedef size_t mwSize;
typedef bool mxLogical;
typedef double mxDouble;
typedef uint8_t mxUint8;
typedef enum { mxREAL, mxCOMPLEX } mxComplexity;
typedef enum { mxUINT8_CLASS = 9 } mxClassID;
bool mxIsDouble(const mxArray *);
bool mxIsComplex(const mxArray *);
bool mxIsSparse(const mxArray *);
bool mxIsEmpty(const mxArray *);
bool mxIsUint8(const mxArray *);
mwSize mxGetNumberOfDimensions(const mxArray *);
size_t mxGetM(const mxArray *);
size_t mxGetN(const mxArray *);
size_t mxGetNumberOfElements(const mxArray *);
mxDouble *mxGetDoubles(const mxArray *);
mxUint8 *mxGetUint8s(const mxArray *);
int mxGetString(const mxArray *, char *, mwSize);
mxArray *mxCreateDoubleMatrix(mwSize, mwSize, mxComplexity);
mxArray *mxCreateNumericMatrix(mwSize, mwSize, mxClassID, mxComplexity);
mxArray *mxCreateLogicalScalar(mxLogical);
_Noreturn void mexErrMsgIdAndTxt(const char *, const char *, ...);
void mexFunction(int, mxArray *[], int, const mxArray *[]);
"""


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_interleaved_complex_numbers(compiler: str, tmp_path: Path) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"there is no {compiler}")
    written = hyst.export.mex(CONTROLLER, tmp_path / "a")
    (written.path / "mex.h").write_text(INTERLEAVED_MEX_H)
    strict = ["-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-O2", "-I.", "-c"]
    command = [compiler, *strict, "stage_mex.c"]
    done = subprocess.run(command, cwd=written.path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_same_model_gives_the_same_bytes(tmp_path: Path) -> None:
    folders = [hyst.export.mex(PI, tmp_path / name) for name in ("a", "b")]
    for file in folders[0].files:
        assert (folders[0].path / file).read_bytes() == (folders[1].path / file).read_bytes()


@pytest.mark.parametrize(
    "name",
    ["end", "function", "mex", "pi", "classdef", "while", "1st", "a b", "nargin", "error", "inv"],
)
def test_names_that_cannot_be(name: str, tmp_path: Path) -> None:
    with pytest.raises(hyst.InputError, match="the name is"):
        hyst.export.mex(PI, tmp_path / "a", name=name)
    assert list(tmp_path.iterdir()) == []


@needs_octave
@pytest.mark.parametrize("name", ["", " ", "end", "1st", "a'b", "%{", "x\ny", "...", "u: y"])
def test_any_name_of_a_signal(name: str, tmp_path: Path) -> None:
    """No name, words of MATLAB, marks that begin a comment, and both alike: none reaches code."""
    about = ModelDescription(input_name=name, input_unit=name, output_name=name, output_unit=name)
    folder = compiled(hyst.export.mex(PI.with_description(about), tmp_path / "a"))
    printed = octave(folder, "help stage\nprintf('%.17g\\n', stage([0.25 0.5]))")
    assert "y = stage(u)" in printed
    # 17 digits are a double exactly.
    assert [float(each) for each in printed.split()[-2:]] == PI(np.array([0.25, 0.5])).tolist()


def test_a_signal_without_a_name_is_called_as_in_the_call(tmp_path: Path) -> None:
    about = ModelDescription(input_name="", output_name="", output_unit="V")
    folder = hyst.export.mex(PI.with_description(about), tmp_path / "a").path
    readme = (folder / "README.md").read_text()
    assert "| u | u |" in readme
    assert "| y | y in V |" in readme
    assert "y: y in V" in (folder / "stage.m").read_text()


def test_a_folder_that_exists(tmp_path: Path) -> None:
    hyst.export.mex(PI, tmp_path / "a")
    with pytest.raises(hyst.InputError, match="exists"):
        hyst.export.mex(INVERSE_MPI, tmp_path / "a")
    again = hyst.export.mex(INVERSE_MPI, tmp_path / "a", name="other", force=True)
    assert {each.name for each in (tmp_path / "a").iterdir()} == set(again.files)
