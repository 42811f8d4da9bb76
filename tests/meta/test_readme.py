"""The README shows only what there is: verbs, options, targets, names and files."""

from __future__ import annotations

import ast
import importlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
OPTION = re.compile(r"(?<![\w-])--?[A-Za-z][\w-]*")
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)|src=\"([^\"#]+)\"")
SHELLS = {"bash", "sh", "shell", "console"}


@pytest.fixture(scope="module")
def readme(repository: Path) -> str:
    text = (repository / "README.md").read_text()
    if not text.strip():
        pytest.skip("README.md is still empty")
    return text


def blocks(text: str, languages: set[str]) -> list[str]:
    return [body for language, body in FENCE.findall(text) if language in languages]


def commands(text: str) -> Iterator[list[str]]:
    """Every command in the shell blocks, split into words."""
    for block in blocks(text, SHELLS):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line.removeprefix("$ "), comments=True)
            command: list[str] = []
            for word in [*words, ";"]:
                if word not in {"&&", "|", ";"}:
                    command.append(word)
                elif command:
                    yield command
                    command = []


HELP = """
import contextlib, io, json, sys
sys.argv[0] = "hyst"
from hyst.cli import main
said = {}
for verb in sys.argv[1:]:
    with contextlib.redirect_stdout(io.StringIO()) as shown:
        code = main([*verb.split(), "--help"])
    assert code == 0, f"hyst {verb} --help ends with {code}"
    said[verb] = shown.getvalue()
print(json.dumps(said))
"""


def help_of(*verbs: str) -> dict[str, str]:
    """What the command line says about verbs, wide enough that nothing is cut off."""
    wide = {"COLUMNS": "250", "TERMINAL_WIDTH": "250", "NO_COLOR": "1", "TERM": "dumb"}
    finished = subprocess.run(
        [sys.executable, "-c", HELP, *verbs],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | wide,
    )
    assert finished.returncode == 0, finished.stderr
    return dict(json.loads(finished.stdout))


def verb_of(words: list[str]) -> str:
    return words[1] if len(words) > 1 and not words[1].startswith("-") else ""


def unknown_options(words: list[str], said: str) -> list[str]:
    """Options of ``hyst VERB ...`` that the help of VERB does not show."""
    options = [word.partition("=")[0] for word in words if OPTION.match(word)]
    known = set(OPTION.findall(said)) | {"--help"}
    return [option for option in options if option not in known]


def test_commands_use_verbs_and_options_there_are(readme: str) -> None:
    uses = [words for words in commands(readme) if words[0] == "hyst"]
    assert uses, "the README shows no hyst command"
    said = help_of(*dict.fromkeys(map(verb_of, uses)))
    wrong = {
        " ".join(words): bad
        for words in uses
        if (bad := unknown_options(words, said[verb_of(words)]))
    }
    assert not wrong


def test_make_targets_exist(readme: str, repository: Path) -> None:
    targets = set(re.findall(r"^([a-z-]+):", (repository / "Makefile").read_text(), re.MULTILINE))
    uses = [words[1:] for words in commands(readme) if words[0] == "make"]
    assert uses, "the README shows no make command"
    named = {word for words in uses for word in words if "=" not in word}
    assert named <= targets


def dotted_names(tree: ast.AST) -> Iterator[str]:
    """Names like hyst.signals.Record, and what is imported from hyst."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and ast.unparse(node).startswith("hyst."):
            yield ast.unparse(node)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "hyst":
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def exists(name: str) -> bool:
    """Whether a dotted name starting with hyst can be reached, as an attribute or a module."""
    found: object = importlib.import_module("hyst")
    for position, part in enumerate(name.split(".")[1:], start=2):
        if not hasattr(found, part):
            try:
                importlib.import_module(".".join(name.split(".")[:position]))
            except ModuleNotFoundError:
                return False
        found = getattr(found, part)
    return True


def test_python_names_exist(readme: str) -> None:
    names = {
        re.match(r"[\w.]+", name).group()  # type: ignore[union-attr]
        for block in blocks(readme, {"python", "py"})
        for name in dotted_names(ast.parse(block))
        if re.fullmatch(r"[\w.]+", name)
    }
    missing = [name for name in sorted(names) if not exists(name)]
    assert not missing


def test_python_blocks_run(readme: str, repository: Path, tmp_path: Path) -> None:
    programs = blocks(readme, {"python", "py"})
    assert programs, "the README shows no Python"
    shutil.copytree(repository / "examples", tmp_path / "examples")
    for program in programs:
        finished = subprocess.run(
            [sys.executable, "-W", "error", "-c", program],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert finished.returncode == 0, finished.stderr
        assert finished.stdout


def test_links_lead_somewhere(readme: str, repository: Path) -> None:
    targets = [first or second for first, second in LINK.findall(readme)]
    local = [
        target for target in targets if "://" not in target and not target.startswith("mailto:")
    ]
    missing = [target for target in local if not (repository / target).exists()]
    assert not missing


def test_a_made_up_name_or_command_is_noticed() -> None:
    text = "```bash\n$ hyst identify a.csv \\\n    --input 0 -o out && make demo\n```\n"
    assert list(commands(text)) == [
        ["hyst", "identify", "a.csv", "--input", "0", "-o", "out"],
        ["make", "demo"],
    ]
    assert exists("hyst.errors.InputError")
    assert not exists("hyst.errors.NoSuchError")
