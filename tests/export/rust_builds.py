"""Crates of models in one workspace, and a program that runs any of them on a record."""

from __future__ import annotations

import os
import pwd
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from hyst.export.c.block import Model
from hyst.export.rust_crate.crate import RustCrate, rust

# Where its installer puts it, which a clean environment does not say.
_OWN = Path(pwd.getpwuid(os.getuid()).pw_dir)
CARGO = shutil.which("cargo") or shutil.which("cargo", path=str(_OWN / ".cargo" / "bin"))
_HOMES = {
    "CARGO_HOME": os.environ.get("CARGO_HOME", str(_OWN / ".cargo")),
    "RUSTUP_HOME": os.environ.get("RUSTUP_HOME", str(_OWN / ".rustup")),
}

needs_cargo = pytest.mark.skipif(CARGO is None, reason="cargo is not installed")

_WORKSPACE = """\
[workspace]
resolver = "2"
members = [{members}]
[profile.dev]
opt-level = 0
debug = false
incremental = false
"""

_MAIN = """\
use std::io::{{Read, Write}};

fn main() {{
    let name = std::env::args().nth(1).expect("a name");
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).expect("a record");
    let numbers: Vec<f64> = bytes
        .chunks_exact(8)
        .map(|each| f64::from_le_bytes(each.try_into().expect("eight bytes")))
        .collect();
    let result = match name.as_str() {{
{arms}
        _ => panic!("no such crate"),
    }};
    std::io::stdout().write_all(&result).expect("an output");
}}
"""

_ARM = """\
        "{name}" => {{
            let mut block = {name}::{kind}::new();
            let mut result = Vec::new();
            for (k, sample) in numbers.chunks_exact({width}).enumerate() {{
                if k == numbers.len() / {width} / 2 {{
                    let saved = block.save();
                    block = {name}::{kind}::new();
                    block.load(&saved).expect("its own state");
                }}
                {step}
                result.extend_from_slice(&f64::from(y).to_le_bytes());
            }}
            result.extend_from_slice(&f64::from(block.fault()).to_le_bytes());
            result
        }}
"""


class Crates:
    """A workspace of crates, built once.

    Parameters
    ----------
    folder
        Where it is made.
    models
        Model and precision by the name of the crate.
    """

    def __init__(self, folder: Path, models: dict[str, tuple[Model, str]]) -> None:
        self.written: dict[str, RustCrate] = {}
        arms = []
        for name, (model, precision) in models.items():
            crate = rust(model, folder / name, precision=precision, name=name)
            self.written[name] = crate
            arms.append(_arm(name, folder / name / "src" / "lib.rs"))
        members = ", ".join(f'"{name}"' for name in (*models, "runner"))
        (folder / "Cargo.toml").write_text(_WORKSPACE.format(members=members))
        runner = folder / "runner"
        (runner / "src").mkdir(parents=True)
        needed = "".join(f'{name} = {{ path = "../{name}" }}\n' for name in models)
        (runner / "Cargo.toml").write_text(
            '[package]\nname = "runner"\nversion = "0.1.0"\nedition = "2021"\n[dependencies]\n'
            + needed
        )
        (runner / "src" / "main.rs").write_text(_MAIN.format(arms="".join(arms)))
        self.folder = folder
        cargo(folder, "build", "--offline", "-q", "-p", "runner")

    def run(self, name: str, *signals: np.ndarray) -> tuple[np.ndarray, int]:
        """Give the output of a crate, and its fault; the state is saved and loaded on the way."""
        record = np.column_stack(signals).astype(np.float64).tobytes()
        program = self.folder / "target" / "debug" / "runner"
        done = subprocess.run([program, name], input=record, capture_output=True, check=True)
        output = np.frombuffer(done.stdout)
        return output[:-1], int(output[-1])


def cargo(folder: Path, *arguments: str) -> str:
    """Run cargo, and give what it prints; warnings are errors."""
    assert CARGO is not None
    done = subprocess.run(
        [CARGO, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, **_HOMES, "RUSTFLAGS": "-D warnings"},
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


def _arm(name: str, library: Path) -> str:
    text = library.read_text()
    kind = text.split("pub struct ")[-1].split(" ")[0]
    if "pub fn update" in text:
        step = "let _ = block.update(sample[0] as _, sample[1] as _);\n"
        step += "                let y = block.command(sample[1] as _);"
        width = 2
    else:
        width = 2 if "run(&mut self, u: &[Real], s" in text or "y_ref: &[Real]" in text else 1
        given = ", ".join(f"sample[{i}] as _" for i in range(width))
        step = f"let y = block.step({given});"
    return _ARM.format(name=name, kind=kind, width=width, step=step)
