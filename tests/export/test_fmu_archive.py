"""What is in an FMU: description, sources, binary, and the same bytes every time."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import fmpy.build
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from fmu_runs import INVERSE_MPI, SHAPES, VERSIONS, FmuRun, has_compiler, rough_signal

import hyst
from hyst import LinearDynamics, Operator
from hyst.models import StableInverse
from hyst.operators import ModelDescription
from reference.examples import LAG, PI

FMPY = Path(fmpy.__file__).parent
HOSTILE = ModelDescription(
    input_name='"/><!-- */ #error\n%s%n',
    output_name="position \N{EN DASH} <b>&amp;",
    input_unit="V]]>\t\x01",
    output_unit="\N{MICRO SIGN}m",
)
MODELS = {**SHAPES, "inverse": INVERSE_MPI}
PARAMETERS = ("p0", "p[1]", "p[2]", "p[3]", "r[1]", "r[2]", "r[3]")


def sources_of(written: hyst.export.Fmu, folder: Path) -> Path:
    with zipfile.ZipFile(written.path) as archive:
        archive.extractall(folder)
    return folder / "sources"


def described(written: hyst.export.Fmu) -> ElementTree.Element:
    with zipfile.ZipFile(written.path) as archive:
        return ElementTree.fromstring(archive.read("modelDescription.xml"))


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", MODELS)
def test_the_description_is_valid(name: str, version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(
        MODELS[name], tmp_path / "a.fmu", version=version, description=HOSTILE, binary=False
    )
    assert validate_fmu(str(written.path)) == []  # schema and FMPy's own rules
    problems = wrong_references(described(written), version)
    assert problems == []


@pytest.mark.parametrize("version", VERSIONS)
def test_signals_without_a_name_are_described_as_the_variables_are(
    version: str, tmp_path: Path
) -> None:
    about = ModelDescription(input_name="", output_name=" ")
    written = hyst.export.fmu(
        PI, tmp_path / "a.fmu", version=version, description=about, binary=False
    )
    assert validate_fmu(str(written.path)) == []
    said = {each.get("name"): each.get("description") for each in described(written).iter()}
    assert (said["u"], said["y"]) == ("u", "y")


def wrong_references(root: ElementTree.Element, version: str) -> list[str]:
    """What FMPy does not look at: that the structure points to the output and to its knowns."""
    variables = list(root.find("ModelVariables"))
    number = {each.get("valueReference"): i for i, each in enumerate(variables, 1)}
    assert len(number) == len(variables), "value references are not unique"

    def named(text: str) -> ElementTree.Element:
        return variables[(int(text) if version == "2.0" else number[text]) - 1]

    which = "index" if version == "2.0" else "valueReference"
    structure = root.find("ModelStructure")
    if version == "2.0":
        found = [*structure.find("Outputs"), None, *structure.find("InitialUnknowns")]
    else:
        found = [*structure.findall("Output"), None, *structure.findall("InitialUnknown")]
    if [each is None for each in found] != [False, True, False]:
        return [f"{len(found)} unknowns"]
    problems = []
    for unknown, allowed in ((found[0], {"input"}), (found[2], {"input", "parameter"})):
        if named(unknown.get(which)).get("causality") != "output":
            problems.append(f"{unknown.tag} is no output")
        for each in unknown.get("dependencies").split():
            if named(each).get("causality") not in allowed:
                problems.append(f"{unknown.tag} depends on {named(each).get('name')}")
    return problems


@pytest.mark.parametrize("version", VERSIONS)
def test_the_variables(version: str, tmp_path: Path) -> None:
    about = ModelDescription("voltage", "position", "V", "um")
    written = hyst.export.fmu(
        PI, tmp_path / "a.fmu", version=version, description=about, binary=False
    )
    model = fmpy.read_model_description(str(written.path))
    found = {each.name: each for each in model.modelVariables}
    assert (found["u"].causality, found["u"].unit, float(found["u"].start)) == ("input", "V", 0.0)
    assert (found["y"].causality, found["y"].unit) == ("output", "um")
    assert (found["u"].description, found["y"].description) == ("voltage", "position")
    assert found["fault"].causality == "local"
    assert written.parameters == PARAMETERS
    values = [PI.p0, *PI.p, *PI.r]
    assert [float(found[name].start) for name in PARAMETERS] == values
    kinds = ["tunable"] * 4 + ["fixed"] * 3
    assert [found[name].variability for name in PARAMETERS] == kinds
    units = {unit.name: unit.baseUnit for unit in model.unitDefinitions}
    assert (units["um"].m, units["um"].factor) == (1, 1e-6)
    assert (units["V"].kg, units["V"].m, units["V"].s, units["V"].A) == (1, 2, -3, -1)


# Where the output does not depend on the input of the same sample, no algebraic loop is closed.
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(
    ("model", "depends"),
    [(PI, True), (LAG, False), (LAG @ PI, False), (SHAPES["linear without order"], True),
     (SHAPES["linear with delay"], False)],
    ids=["pi", "lag", "lag after pi", "gain", "delay"],
)  # fmt: skip
def test_dependencies(model: Operator, depends: bool, version: str, tmp_path: Path) -> None:
    u = np.zeros(8)
    u[-1] = 1.0
    assert bool(model(u)[-1] != model(0.0 * u)[-1]) is depends  # what is told is true
    written = hyst.export.fmu(model, tmp_path / "a.fmu", version=version, binary=False)
    output = fmpy.read_model_description(str(written.path)).outputs[0]
    assert [each.name for each in output.dependencies] == ["u"] * depends


@pytest.mark.parametrize("version", VERSIONS)
def test_the_step_size_is_told(version: str, tmp_path: Path) -> None:
    sampled = hyst.export.fmu(LAG, tmp_path / "a.fmu", version=version, binary=False)
    any_step = hyst.export.fmu(PI, tmp_path / "b.fmu", version=version, binary=False)
    assert described(sampled).find("DefaultExperiment").get("stepSize") == "0.01"
    assert described(any_step).find("DefaultExperiment") is None
    can = "canHandleVariableCommunicationStepSize"
    assert described(sampled).find("CoSimulation").get(can) == "false"
    assert described(any_step).find("CoSimulation").get(can) == "true"
    if version == "3.0":
        assert described(sampled).find("CoSimulation").get("fixedInternalStepSize") == "0.01"


@has_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_the_same_model_gives_the_same_bytes(version: str, tmp_path: Path) -> None:
    twice = [
        hyst.export.fmu(INVERSE_MPI, tmp_path / f"{i}.fmu", version=version, description=HOSTILE)
        for i in range(2)
    ]
    assert twice[0].path.read_bytes() == twice[1].path.read_bytes()
    other = hyst.export.fmu(PI, tmp_path / "other.fmu", version=version, binary=False)
    assert other.token != twice[0].token
    with zipfile.ZipFile(other.path) as archive:
        manifest = json.loads(archive.read("resources/manifest.json"))
    assert manifest["target"] == "fmu"


def test_sources_of_the_core_change_nothing_but_their_names(tmp_path: Path) -> None:
    core = Path(__file__).resolve().parents[2] / "core"
    sources = sources_of(hyst.export.fmu(INVERSE_MPI, tmp_path / "a.fmu", binary=False), tmp_path)
    copies = [each for each in sources.glob("stage_core_*") if not each.name.endswith("_real.h")]
    assert len(copies) > 4
    for copy in copies:
        folder = core / "include/hyst" if copy.suffix == ".h" else core / "src"
        original = (folder / copy.name.removeprefix("stage_core_")).read_text()
        for before, after in (
            ("hyst/", "stage_core_"),
            ("hyst_", "stage_core_"),
            ("HYST_", "STAGE_CORE_"),
        ):
            original = original.replace(before, after)
        assert copy.read_text() == original


@has_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_an_importer_can_build_the_binary(version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(INVERSE_MPI, tmp_path / "a.fmu", version=version, binary=False)
    assert not any(each.startswith("binaries/") for each in written.files)
    unpacked = tmp_path / "a-unpacked"
    sources_of(written, unpacked)
    (tmp_path / "build").mkdir()
    fmpy.build.build_platform_binary(
        unpacked, tmp_path / "build", cmake_options={"CMAKE_C_FLAGS": "-Wall -Werror"}
    )
    run = FmuRun(written, tmp_path).initialize()
    u = rough_signal(200)
    assert run.run(u, 1.0).tobytes() == INVERSE_MPI(u).tobytes()
    run.free()


@has_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_our_declarations_are_the_standards(version: str, tmp_path: Path) -> None:
    """Compiled with the standard's own headers in the place of ours."""
    sources = sources_of(
        hyst.export.fmu(PI, tmp_path / "a.fmu", version=version, binary=False), tmp_path
    )
    number = version[0]
    header = sources / f"hyst_fmi{number}.h"
    functions = {line.split()[1] for line in header.read_text().splitlines()
                 if line.startswith(f"#define fmi{number}") and "HYST" in line}  # fmt: skip
    assert len(functions) > 30
    header.write_text(f'#include "fmi{number}Functions.h"\n')
    compile_all(sources, f"-I{FMPY / 'c-code'}", "-Wno-strict-prototypes")
    assert functions <= exported(sources / "library")


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_compilers_that_would_fuse_products_and_sums(compiler: str, tmp_path: Path) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"there is no {compiler}")
    sources = sources_of(hyst.export.fmu(INVERSE_MPI, tmp_path / "a.fmu", binary=False), tmp_path)
    # What a compiler line could ask for and still be called C; the source says otherwise.
    fused = ["-std=gnu17", "-O3", "-march=native"] + ["-ffp-contract=fast"] * (compiler == "gcc")
    run_cc([*fused, "-fPIC", "-shared", "hyst_all.c", "-o", "library"], sources, compiler)
    unpacked = tmp_path / "b-unpacked"
    (unpacked / "binaries/linux64").mkdir(parents=True)
    (sources / "library").rename(unpacked / "binaries/linux64/stage.so")
    (tmp_path / "modelDescription.xml").rename(unpacked / "modelDescription.xml")
    (tmp_path / "a.fmu").rename(tmp_path / "b.fmu")
    written = hyst.export.fmu(INVERSE_MPI, tmp_path / "b.fmu", binary=False, force=True)
    folder = tmp_path
    run = FmuRun(written, folder).initialize()
    u = rough_signal(1000)
    assert run.run(u, 1.0).tobytes() == INVERSE_MPI(u).tobytes()
    run.free()


@has_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_two_fmus_linked_into_one_program(version: str, tmp_path: Path) -> None:
    objects = []
    prefix = f"-DFMI{version[0]}_FUNCTION_PREFIX="
    for name, model in (("first", PI), ("second", INVERSE_MPI)):
        written = hyst.export.fmu(
            model, tmp_path / f"{name}.fmu", version=version, name=name, binary=False
        )
        sources = sources_of(written, tmp_path / name)
        run_cc([f"{prefix}{name}_", "-fPIC", "-c", "hyst_all.c", "-o", "all.o"], sources)
        objects.append(str(sources / "all.o"))
    run_cc(["-shared", "-Wl,-z,defs", *objects, "-o", "both"], tmp_path)
    assert {f"first_fmi{version[0]}DoStep", f"second_fmi{version[0]}DoStep"} <= {
        line.split()[-1]
        for line in subprocess.check_output(["nm", "both"], cwd=tmp_path, text=True).splitlines()
    }


@has_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_nothing_but_fmi_is_seen_from_outside(version: str, tmp_path: Path) -> None:
    sources = sources_of(
        hyst.export.fmu(PI, tmp_path / "a.fmu", version=version, binary=False), tmp_path
    )
    run_cc(["-shared", "-fPIC", "-O2", "hyst_all.c", "-o", "library"], sources)
    assert all(name.startswith("fmi") for name in exported(sources / "library"))


def run_cc(arguments: list[str], folder: Path, compiler: str = "cc") -> None:
    subprocess.run([compiler, "-I.", *arguments], cwd=folder, check=True, capture_output=True)


def compile_all(sources: Path, *options: str) -> None:
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Werror"]
    run_cc([*strict, *options, "-fPIC", "-shared", "hyst_all.c", "-o", "library"], sources)


def exported(library: Path) -> set[str]:
    listing = subprocess.check_output(["nm", "-D", "--defined-only", library], text=True)
    return {line.split()[-1] for line in listing.splitlines()} - {"_init", "_fini"}


def test_a_path_that_cannot_be(tmp_path: Path) -> None:
    with pytest.raises(hyst.InputError, match=r"ends in \.fmu"):
        hyst.export.fmu(PI, tmp_path / "a.zip", binary=False)
    (tmp_path / "mine.fmu").write_text("not hyst's")
    with pytest.raises(hyst.InputError, match="exists"):
        hyst.export.fmu(PI, tmp_path / "mine.fmu", binary=False)
    with pytest.raises(hyst.InputError, match="not an earlier export"):
        hyst.export.fmu(PI, tmp_path / "mine.fmu", binary=False, force=True)
    assert (tmp_path / "mine.fmu").read_text() == "not hyst's"
    first = hyst.export.fmu(PI, tmp_path / "a.fmu", binary=False)
    again = hyst.export.fmu(PI, tmp_path / "a.fmu", version="3.0", binary=False, force=True)
    assert fmpy.read_model_description(str(first.path)).fmiVersion == again.version


def test_what_cannot_be_asked_for(tmp_path: Path) -> None:
    with pytest.raises(hyst.InputError, match="version"):
        hyst.export.fmu(PI, tmp_path / "a.fmu", version="1.0")
    with pytest.raises(hyst.InputError, match="word of C"):
        hyst.export.fmu(PI, tmp_path / "a.fmu", name="while")
    assert list(tmp_path.iterdir()) == []


def test_without_a_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(hyst.InputError, match="no-such-cc"):
        hyst.export.fmu(PI, tmp_path / "a.fmu", compiler="no-such-cc")
    with pytest.raises(hyst.InputError, match="there is no C compiler"):
        hyst.export.fmu(PI, tmp_path / "a.fmu", compiler="gcc '-O2")
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", os.fspath(tmp_path))
    with pytest.raises(hyst.HystError, match=r"no C compiler was found.*leave the binary out"):
        hyst.export.fmu(PI, tmp_path / "a.fmu")
    assert not (tmp_path / "a.fmu").exists()


def test_a_compiler_that_fails(tmp_path: Path) -> None:
    with pytest.raises(hyst.HystError, match="could not compile"):
        hyst.export.fmu(PI, tmp_path / "a.fmu", compiler="false")


def test_what_looks_ahead_has_no_fmu(tmp_path: Path) -> None:
    dynamics = LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.3], 1.0, dt=1e-3)
    with pytest.raises(hyst.InputError, match="samples ahead"):
        hyst.export.fmu(StableInverse.of(dynamics), tmp_path / "a.fmu")
    with pytest.raises(hyst.NotInvertibleError):
        hyst.export.fmu(dynamics.inverse(), tmp_path / "a.fmu")
    assert list(tmp_path.iterdir()) == []


def test_the_licence_goes_with_the_sources(tmp_path: Path) -> None:
    licence = Path(__file__).resolve().parents[2] / "LICENSE"
    written = hyst.export.fmu(PI, tmp_path / "a.fmu", binary=False)
    with zipfile.ZipFile(written.path) as archive:
        copy = archive.read("documentation/licenses/license.txt")
    assert copy == licence.read_bytes()
