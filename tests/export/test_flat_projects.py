"""A project that a build without paths of includes takes as it is."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from c_builds import STRICT, compiled, compiler

from hyst import PrandtlIshlinskii
from hyst.export import c_project
from hyst.models import ColemanHodgdon, Dahl, JilesAtherton
from hyst.operators import Affine

PI = PrandtlIshlinskii(p=[0.5, 0.2], r=[0.1, 0.3], p0=1.0)
MODELS = {
    "pi": PI,
    "inverse": PI.inverse(),
    "chain": Affine(-1.0, 2.0) @ PI,
    "dahl": Dahl(sigma=2.0, Fc=1.0),
    "coleman-hodgdon": ColemanHodgdon(1.0, [2.0, 1.0], [1.5, 0.75], [1.0]).inverse(),
    "jiles-atherton": JilesAtherton(2.0, 1.0, 0.5, 0.25, 0.75, "jiles-thoelke-devine-1992"),
}


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", MODELS)
def test_every_file_compiles_without_a_path_and_the_self_test_passes(
    tmp_path: Path, name: str, precision: str
) -> None:
    folder = tmp_path / "library"
    project = c_project(MODELS[name], folder, name="lens", precision=precision, flat=True)
    code = [file for file in project.files if file.endswith((".c", ".h"))]
    assert {Path(file).parent.as_posix() for file in code} == {".", "selftest"}
    assert not any(b'"hyst/' in (folder / file).read_bytes() for file in code)
    build = [compiler("gcc"), "-std=c99", *STRICT, *(["-DHYST_SINGLE"] * (precision == "single"))]
    # From another folder, so that nothing is found by chance.
    objects = tmp_path / "objects"
    objects.mkdir()
    for source in sorted(folder.glob("*.c")):
        compiled([*build, "-c", str(source)], objects)
    test = [*build, str(folder / "selftest" / "selftest.c"), *map(str, objects.glob("*.o"))]
    compiled([*test, "-o", "selftest", "-lm"], objects)
    subprocess.run([str(objects / "selftest")], check=True, capture_output=True)


def test_the_readme_and_cmake_name_no_folder_that_is_not_there(tmp_path: Path) -> None:
    folder = c_project(PI, tmp_path / "library", name="lens", flat=True).path
    for text in ("README.md", "CMakeLists.txt"):
        assert "core/" not in (folder / text).read_text()
    readme = (folder / "README.md").read_text()
    command = next(line for line in readme.splitlines() if "_test && " in line)
    compiler("cc")
    subprocess.run(command, shell=True, cwd=folder, check=True, capture_output=True)


def test_numbers_are_those_of_the_other_layout(tmp_path: Path) -> None:
    usual = c_project(PI, tmp_path / "usual", name="lens").path
    flat = c_project(PI, tmp_path / "flat", name="lens", flat=True).path
    for path in usual.rglob("*.[ch]"):
        place = path.relative_to(usual)
        core = place.parts[0] == "core"
        twin = flat / (f"hyst_{path.name}" if core else place)
        twin = twin if twin.exists() else flat / "selftest" / path.name
        plain = twin.read_text().replace('"hyst_', '"hyst/').replace('"../lens.h"', '"lens.h"')
        assert plain == path.read_text(), place
