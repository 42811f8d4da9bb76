"""Files of version 2 are read; what they could not say is refused in them."""

from __future__ import annotations

from pathlib import Path

import pytest

import hyst

VERSION_2 = '{"format": "hyst model", "version": 2, "description": {%s}, "model": %s}'
PLAY = '{"kind": "play", "r": 1.0}'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "model.json"


def test_version_2_is_read(file: Path) -> None:
    file.write_text(VERSION_2 % ('"delay": 4, "errors": {"training": {"rms": 0.5}}', PLAY))
    about = hyst.load(file).description
    assert (about.delay, about.verdict, about.delay_interval) == (4, None, None)
    assert about.errors == {"training": {"rms": 0.5}}


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ('"delay": 0.5', r"delay is 0\.5; in files of this version it is a whole"),
        ('"delay": -3', "delay is -3; in files of this version it is a whole"),
        ('"delay_interval": [0, 1]', "unknown entry 'delay_interval' in 'description'"),
        ('"verdict": {"level": "good", "sentences": ["Noise."]}', "unknown entry 'verdict'"),
    ],
)
def test_what_version_2_did_not_know(file: Path, entries: str, message: str) -> None:
    file.write_text(VERSION_2 % (entries, PLAY))
    with pytest.raises(hyst.InputError, match=message) as refused:
        hyst.load(file)
    assert str(file) in str(refused.value)


def test_a_whole_delay_stays_whole_in_the_file(file: Path) -> None:
    hyst.Play(1.0).save(file, hyst.ModelDescription(delay=2.0, delay_interval=(-1.0, 2.5)))
    text = file.read_text(encoding="utf-8")
    assert '"delay": 2,' in text
    assert '"delay_interval": [-1, 2.5]' in text
