"""What the page shows and does: one session, whatever the number of tabs."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hyst.errors import HystError
from hyst.studio.work.choice import Choice
from hyst.studio.work.commands import Session
from hyst.studio.work.folder import WorkFolder, plain_name
from hyst.studio.work.following import Followed, follow
from hyst.studio.work.identifying import AUTO, FoundModel, find_model, overlay
from hyst.studio.work.jobs import Place, save
from hyst.studio.work.looking import Look, look
from hyst.studio.work.measuring import Measured, measure
from hyst.studio.work.reference import Reference
from hyst.studio.work.sentences import sentence_of
from hyst.studio.work.worker import CancelledError, Worker

PARTS = ("file", "columns", "record", "identify", "models", "reference", "save")


@dataclass
class Progress:
    """How far an identification is.

    Parameters
    ----------
    step, share
        As of ``hyst.identification.progress.Step``.
    """

    step: str
    share: float


class StudioSession:
    """The state behind the page.

    Parameters
    ----------
    folder
        Where the studio was started.
    """

    def __init__(self, folder: WorkFolder) -> None:
        self.folder = folder
        self.quick = Worker(("hyst.studio.work.looking", "hyst.studio.work.measuring"))
        self.long = Worker(("hyst.studio.work.identifying",))
        self.said: dict[str, str] = {}
        self.busy: set[str] = set()
        self.progress: Progress | None = None
        self.listeners: list[Callable[[str], None]] = []
        self._wanted = asyncio.Event()
        self._forget_file()

    def _forget_file(self) -> None:
        self.file = ""
        self.look: Look | None = None
        self.choice = Choice()
        self._forget_record()

    def _forget_record(self) -> None:
        self.measured: Measured | None = None
        self.models: list[FoundModel] = []
        self.pictures: tuple[str, str] | None = None
        self.chosen = ""
        self.reference: Reference | None = None
        self.followed: Followed | None = None
        self.saved: tuple[str, ...] = ()
        self.saved_in = ""

    def changed(self, *parts: str) -> None:
        """Tell every page what to draw again.

        Parameters
        ----------
        parts
            Of the page.
        """
        for each in tuple(self.listeners):
            for part in parts:
                each(part)

    def stop(self) -> None:
        """End the work that is going on."""
        self.quick.stop()
        self.long.stop()

    async def choose_file(self, name: str, table: int | None = None) -> None:
        """Look at a file of the folder.

        Parameters
        ----------
        name
            Of the file, from the folder.
        table
            Which of its tables, from 1.
        """
        if self.progress is not None:
            self.cancel()
        self._forget_file()
        self.file = name
        async with _Doing(self, "file", *PARTS):
            path = self.folder.readable(name)
            self.look = await self.quick.run(look, path, table)
            self.choice = self.look.guess
        if self.look is not None:
            await self.read()

    async def choose_role(self, column: int, role: str) -> None:
        """Give a column a role, and read the record if nothing is missing.

        Parameters
        ----------
        column, role
            As of ``Choice.with_role``.
        """
        await self.read_as(self.choice.with_role(column, role))

    async def read_as(self, choice: Choice) -> None:
        """Read the record in another way.

        Parameters
        ----------
        choice
            How.
        """
        if choice == self.choice:
            return
        self.choice = choice
        await self.read()

    async def read(self) -> None:
        """Read the record as chosen and diagnose it, or say what is missing."""
        if self.progress is not None:
            self.cancel()
        choice = self.choice
        self._forget_record()
        if choice.missing():
            self.said["record"] = choice.missing()
            self.changed(*PARTS)
            return
        async with _Doing(self, "record", *PARTS):
            path = self.folder.readable(self.file)
            measured = await self.quick.run(measure, path, choice)
            if choice == self.choice:  # else it was read in yet another way meanwhile
                self.measured = measured

    async def identify(self, family: str = AUTO) -> None:
        """Identify a model, with progress; the page goes on meanwhile.

        Parameters
        ----------
        family
            As of ``hyst.identify``.

        Raises
        ------
        CancelledError
            Not to the caller: another record was chosen meanwhile, and the page says so.
        """
        if self.progress is not None or self.measured is None:
            return
        self.progress = Progress("starting", 0.0)
        name, measured = self._free_name(family), self.measured
        try:
            async with _Doing(self, "identify", "identify"):
                path = self.folder.readable(self.file)
                given = (path, self.choice, family, name)
                found = await self.long.run(find_model, *given, tell=self._step)
                if self.measured is not measured:
                    raise CancelledError("another record was chosen meanwhile")
                self.models.append(found)
        finally:
            self.progress = None
            self.changed("identify")
        if self.measured is measured and self.models and self.models[-1].name == name:
            await self._overlay()
            if found.level != "unfit":
                await self.choose_model(name)
            elif not self.chosen:
                self.said["reference"] = _no_command(found)
                self.changed("reference")

    def _step(self, step: str, share: float) -> None:
        if self.progress is not None:
            self.progress.step, self.progress.share = step, share
            self.changed("progress")

    def cancel(self) -> None:
        """End the identification that is going on."""
        if self.progress is not None:
            self.long.cancel()

    async def remove(self, name: str) -> None:
        """Take a model off the list.

        Parameters
        ----------
        name
            Of the model.
        """
        self.models = [each for each in self.models if each.name != name]
        if self.chosen == name:
            self.chosen, self.followed = "", None
        self.changed("models", "reference", "save")
        await self._overlay()

    async def _overlay(self) -> None:
        self.pictures = None
        if self.models:
            async with _Doing(self, "models", "models", "reference", "save"):
                path = self.folder.readable(self.file)
                given = (path, self.choice, tuple(self.models))
                self.pictures = await self.quick.run(overlay, *given)
        else:
            self.changed("models")

    async def choose_model(self, name: str) -> None:
        """Make commands with this model from now on.

        Parameters
        ----------
        name
            Of the model.
        """
        model = next(each for each in self.models if each.name == name)
        if model.level == "unfit":
            self.said["reference"] = _no_command(model)
            self.changed("reference")
            return
        self.chosen = name
        if self.reference is None and self.measured is not None:
            low, high = self.measured.output_range
            length = self.measured.samples * self.measured.dt
            frequency = float(f"{10.0 / length:.2g}")
            self.reference = Reference(0.5 * (low + high), 0.3 * (high - low), frequency)
        self.changed("models", "reference", "save")
        await self.follow()

    async def follow(self, reference: Reference | None = None) -> None:
        """Make the command for a reference; of many asked for at a time only the last one.

        Parameters
        ----------
        reference
            Another one; None for that there is.
        """
        if reference is not None:
            self.reference = reference
        self._wanted.set()
        if "reference" in self.busy:
            return
        while self._wanted.is_set():
            self._wanted.clear()
            model = next((each for each in self.models if each.name == self.chosen), None)
            if model is None or self.reference is None:
                return
            found = None
            async with _Doing(self, "reference"):
                found = await self.quick.run(follow, model, self.reference)
            before, self.followed = self.followed, found
            self.changed("tracking")
            if _method(before) != _method(found):
                self.changed("save")

    def session(self, exports: tuple[str, ...] = ()) -> Session:
        """Give what the session came to.

        Parameters
        ----------
        exports
            Targets.
        """
        method = _method(self.followed) if self.chosen else ""
        record = self.file.rpartition("/")[2]
        models = tuple(self.models)
        return Session(record, self.choice, models, self.chosen, method, exports)

    async def save(self, name: str, exports: tuple[str, ...]) -> None:
        """Write the session into a folder.

        Parameters
        ----------
        name
            Of the folder.
        exports
            Targets.
        """
        self.saved, self.saved_in = (), ""
        refusals: tuple[str, ...] = ()
        async with _Doing(self, "save", "save"):
            place = Place(self.folder.readable(self.file), self.folder.inside(plain_name(name)))
            given = (place, self.session(exports), self.reference)
            done = await self.quick.run(save, *given)
            self.saved, self.saved_in = done.files, name
            refusals = done.refusals
        if refusals:
            self.said["save"] = " ".join(refusals)
            self.changed("save")

    def free_folder(self) -> str:
        """Name a folder for a session that is not there yet."""
        number = 1
        while (self.folder.root / f"studio-{number}").exists():
            number += 1
        return f"studio-{number}"

    def _free_name(self, family: str) -> str:
        taken = {each.name for each in self.models}
        if family not in taken:
            return family
        return next(f"{family}-{k}" for k in range(2, 1000) if f"{family}-{k}" not in taken)


def _method(followed: Followed | None) -> str:
    return "" if followed is None else followed.method


def _no_command(model: FoundModel) -> str:
    return f"No command comes from {model.name}, which is unfit: {' '.join(model.sentences)}"


class _Doing:
    """Something of a part that takes time, and that may be refused in a sentence."""

    def __init__(self, session: StudioSession, part: str, *shown: str) -> None:
        self._session, self._part, self._shown = session, part, shown

    async def __aenter__(self) -> None:
        self._session.said.pop(self._part, None)
        self._session.busy.add(self._part)
        self._session.changed(*self._shown)

    async def __aexit__(self, kind: Any, error: BaseException | None, trace: Any) -> bool:
        self._session.busy.discard(self._part)
        if error is not None and not isinstance(error, Exception):
            return False
        if error is not None:
            said = str(error) if isinstance(error, HystError) else sentence_of(error)
            # Of the folder all know where it is.
            self._session.said[self._part] = said.replace(f"{self._session.folder.root}/", "")
        self._session.changed(*self._shown)
        return True
