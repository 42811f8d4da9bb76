"""The report: whole files, a page that needs nothing but itself, pictures that show something."""

from __future__ import annotations

import base64
import io
import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from PIL import Image

import hyst
from hyst.identification import Identified
from hyst.models import PrandtlIshlinskii
from hyst.operators import Affine, Operator
from hyst.report import Section, Table, write_report
from hyst.report.identification_report import FILES

PICTURES = ("loop.png", "history.png", "error.png", "model.png")
VOID = {"meta", "img", "link", "br", "hr", "input"}
STAGE = Affine(1.0, 2.0) @ PrandtlIshlinskii(p=[0.5, 0.3], r=[0.4, 1.1], p0=1.0)


class Reader(HTMLParser):
    """Collects what a browser would see, and refuses tags that do not match."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text: list[str] = []
        self._open: list[str] = []
        self.feed(text)
        self.close()
        assert self._open == []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attributes)))
        if tag not in VOID:
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self._open and self._open[-1] != "style":
            self.text.append(data)

    @property
    def words(self) -> str:
        return " ".join(" ".join(self.text).split())


def pixels(png: bytes) -> np.ndarray:
    return matplotlib.image.imread(io.BytesIO(png), format="png")


def hold_to_be_a_picture(png: bytes) -> None:
    image = pixels(png)
    assert image.shape[0] > 200
    assert image.shape[1] > 400
    # A blank page has no spread; thin lines over a tenth of it give some percent.
    assert image[..., :3].std() > 0.02
    # Something besides grey: the model's colour.
    assert (np.ptp(image[..., :3], axis=-1) > 0.3).any()


def stage_record(stage: Operator = STAGE, samples: int = 600, seed: int = 1) -> hyst.Record:
    t = np.linspace(0.0, 1.0, samples)
    u = 2.0 - 2.0 * np.cos(10.0 * math.pi * t) * (1.0 - 0.5 * t * (t > 0.4))
    noise = np.random.default_rng(seed).normal(0.0, 1e-2, samples)
    names = {"input_name": "drive", "output_name": "stroke"}
    return hyst.Record(u, stage(u) + noise, 0.01, **names, input_unit="V", output_unit="um")


def found_in(record: hyst.Record, family: str = "pi", plays: object = 2) -> Identified:
    options = {"plays": plays} if "plays" in hyst.families[family].options() else {}
    return hyst.identify(record, family=family, delay=0, **options)


@pytest.fixture(scope="module")
def record() -> hyst.Record:
    return stage_record()


@pytest.fixture(scope="module")
def kept() -> hyst.Record:
    return stage_record(seed=2)


@pytest.fixture(scope="module")
def found(record: hyst.Record, kept: hyst.Record) -> Identified:
    return hyst.identify(record, plays=2, delay=0, validation=kept)


@pytest.fixture(scope="module")
def folder(
    found: Identified,
    record: hyst.Record,
    kept: hyst.Record,
    tmp_path_factory: pytest.TempPathFactory,
) -> Path:
    """The folder of one report, which several tests look at."""
    out = tmp_path_factory.mktemp("report") / "out"
    files = write_report(found, record, kept, out, sources=["a.csv", "b.csv"])
    assert files == tuple(out / name for name in FILES)
    return out


@pytest.fixture(scope="module")
def page(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")


def test_all_files_are_written(found: Identified, folder: Path) -> None:
    assert sorted(path.name for path in folder.iterdir()) == sorted(FILES)
    assert hyst.load(folder / "model.json") == found.model
    numbers = json.loads((folder / "metrics.json").read_text())
    assert numbers["metrics"] == found.to_dict()["metrics"]
    assert len(numbers["parameters"]) == len(found.parameter_names)
    for name in PICTURES:
        hold_to_be_a_picture((folder / name).read_bytes())


def test_the_same_result_gives_the_same_files(
    found: Identified, record: hyst.Record, kept: hyst.Record, folder: Path
) -> None:
    contents = [(folder / name).read_bytes() for name in FILES]
    again = write_report(found, record, kept, folder, sources=["a.csv", "b.csv"])
    assert [path.read_bytes() for path in again] == contents


def test_the_page_needs_nothing_but_itself(page: str) -> None:
    reader = Reader(page)
    names = {tag for tag, _ in reader.tags}
    assert not names & {"script", "link", "iframe", "object", "embed", "base", "form"}
    anchors = {f"#{attributes['id']}" for tag, attributes in reader.tags if tag == "h2"}
    for tag, attributes in reader.tags:
        assert not {"onload", "onerror", "style"} & set(attributes), tag
        assert tag == "img" or "src" not in attributes
        assert "href" not in attributes or (tag == "a" and attributes["href"] in anchors)
    for outside in ("http:", "https:", "url(", "@import", "//cdn"):
        assert outside not in page


def test_pictures_of_the_page_are_those_of_the_files_panel_by_panel(
    folder: Path, page: str
) -> None:
    images = [attributes for tag, attributes in Reader(page).tags if tag == "img"]
    panels = []
    for name in PICTURES:
        with Image.open(folder / name) as whole:
            told = json.loads(whole.info["hyst panels"])["panels"]
            panels += [(np.asarray(whole.convert("RGB").crop(each["box"])), each) for each in told]
    # The loop twice, training and validation twice each, four views of the error, two of the model.
    assert len(images) == len(panels) == 12
    prefix = "data:image/png;base64,"
    for image, (expected, told) in zip(images, panels, strict=True):
        source = image["src"] or ""
        assert source.startswith(prefix)
        content = base64.b64decode(source.removeprefix(prefix), validate=True)
        with Image.open(io.BytesIO(content)) as shown:
            assert np.array_equal(np.asarray(shown.convert("RGB")), expected)
        assert image["alt"] == told["words"]
    assert images[0]["alt"] == "Loop: stroke [um] over drive [V]; record, model"


def test_what_matters_comes_first_and_then_what_there_is(page: str) -> None:
    places = [page.index(part) for part in ('class="verdict', "<figure>", "<nav", "<h2")]
    assert places == sorted(places)
    listed = page[page.index("<nav") : page.index("</nav>")]
    headings = re.findall(r'<h2 id="([a-z0-9-]+)">(.*?)</h2>', page)
    assert re.findall(r'<a href="#([a-z0-9-]+)">(.*?)</a>', listed) == headings
    assert len(headings) == len({anchor for anchor, _ in headings}) == 5
    assert page.count("<nav") == page.count("<h1>") == 1


def test_the_page_says_what_was_found(found: Identified, folder: Path, page: str) -> None:
    words = Reader(page).words
    training, validation = found.metrics["training"], found.metrics["validation"]
    expected = [
        "Hysteresis of stroke over drive",
        f"{training.rms_percent:.3f}",
        f"{training.nrmse_fit_percent:.2f}",
        f"{validation.rms_percent:.3f}",
        "exact inverse",
        "<- chosen",
        "a.csv",
        "b.csv",
        "600",
        "0.01 s",
        f"hyst compensate {folder}/model.json",
        *found.parameter_names,
        *(each.family for each in found.candidates),
    ]
    for part in expected:
        assert part in words
    for sentence in found.undetermined:
        assert sentence in words


def test_the_chosen_candidate_stands_out(page: str) -> None:
    rows = [tag for tag, attributes in Reader(page).tags if attributes.get("class") == "marked"]
    assert rows == ["tr"]


def test_names_from_the_user_s_file_are_text_and_nothing_else(tmp_path: Path) -> None:
    hostile = "<script>alert('x')</script>\"'&$\\frac{$ \u4e2d"
    record = replace(
        stage_record(),
        input_name=hostile,
        output_name=hostile,
        input_unit="<img src=x>",
        output_unit='"><b>',
        notes=("<i>note</i>",),
    )
    *_, page = write_report(
        found_in(record), record, (), tmp_path / "o'u<t", sources=["<u>.csv"], banner="<b>&"
    )
    reader = Reader(page.read_text(encoding="utf-8"))
    assert not {tag for tag, _ in reader.tags} & {"script", "b", "i", "u", "t"}
    assert sum(tag == "figure" for tag, _ in reader.tags) == len(PICTURES)
    words = reader.words
    for part in (hostile, "<img src=x>", "<i>note</i>", "<u>.csv", "<b>&", "o'\"'\"'u<t"):
        assert part in words


@pytest.mark.parametrize("family", ["linear", "pi", "gpi", "mpi"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_family_has_its_equation_and_pictures(
    family: str, sign: float, tmp_path: Path
) -> None:
    record = stage_record(Affine(sign) @ STAGE, 300)
    *_, page = write_report(found_in(record, family), record, (), tmp_path / "out")
    equations = [
        text for text in Reader(page.read_text(encoding="utf-8")).text if text.startswith("y(t) =")
    ]
    assert len(equations) == 1
    assert equations[0].startswith("y(t) = -") == (sign < 0.0 and family != "linear")
    for name in PICTURES:
        hold_to_be_a_picture((tmp_path / "out" / name).read_bytes())


@pytest.mark.usefixtures("undrawn")
def test_several_records_and_validations(tmp_path: Path) -> None:
    records = [stage_record(seed=seed, samples=300) for seed in (1, 2)]
    kept = [stage_record(seed=seed, samples=250) for seed in (3, 4)]
    found = hyst.identify(records, family="pi", plays=2, delay=0, validation=kept)
    *_, page = write_report(found, records, kept, tmp_path / "out")
    words = Reader(page.read_text(encoding="utf-8")).words
    for label in ("training 1", "training 2", "validation 1", "validation 2"):
        assert label in words


@pytest.mark.usefixtures("undrawn")
def test_a_delay_is_explained_and_drawn(tmp_path: Path) -> None:
    record = stage_record()
    late = hyst.Record(record.u, np.concatenate([[record.y[0]] * 3, record.y[:-3]]), record.dt)
    found = hyst.identify(late, family="pi", plays=2, delay=3)
    *_, page = write_report(found, late, (), tmp_path / "out")
    assert "lags the model by 3 samples, 30 ms" in Reader(page.read_text()).words


def test_a_perfect_model_and_a_model_without_inverse(tmp_path: Path) -> None:
    u = stage_record().u
    exact = hyst.Record(u, Affine(2.0)(u), 0.01)
    perfect = found_in(exact, "linear")
    write_report(perfect, exact, (), tmp_path / "perfect")
    plays = PrandtlIshlinskii(p=[1.0], r=[0.5])
    *_, page = write_report(replace(perfect, model=plays), exact, (), tmp_path / "plays")
    words = Reader(page.read_text(encoding="utf-8")).words
    assert "no exact inverse: p0 is 0" in words
    assert "hyst compensate" not in words
    assert "hyst simulate" in words


def test_a_banner_and_a_further_section(
    found: Identified, record: hyst.Record, kept: hyst.Record, folder: Path, tmp_path: Path
) -> None:
    png = (folder / "loop.png").read_bytes()
    table = Table("Of something", ("a", "b"), (("1", "2"),))
    section = Section("More", ("Said here.",), table, "more.png", png, "Seen here.")
    files = write_report(
        found, record, kept, tmp_path / "out", banner="SIMULATED", sections=[section]
    )
    assert files[-1] == tmp_path / "out" / "more.png"
    assert files[-1].read_bytes() == png
    words = Reader((tmp_path / "out" / "report.html").read_text(encoding="utf-8")).words
    for part in ("SIMULATED", "More", "Said here.", "Of something", "Seen here."):
        assert part in words
    # The banner is in every picture too.
    for name in PICTURES:
        assert (tmp_path / "out" / name).read_bytes() != (folder / name).read_bytes()
