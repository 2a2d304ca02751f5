"""Which files of a laboratory's folder make one case: a surface, a rubber and what belongs to them.

Where several files could be the surface or the rubber, the caller is asked; otherwise the likeliest
is taken, and a finding says so. Shift factors, strain sweeps and friction are those whose names
have most in common with the rubber's.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from pathlib import Path
from types import MappingProxyType

from gripscale.case_file.kinds import RUBBERS, SURFACES, UNUSED, FileKeys, Taken, joinable, take
from gripscale.case_file.proposals import BY_A_FACTOR, OF_ANOTHER_CASE, assumption, open_rubber
from gripscale.core import Finding

Ask = Callable[[str, Sequence[str]], str]
"""Returns one of several answers to a question."""


def first_choice(question: str, answers: Sequence[str]) -> str:
    """Return the likeliest answer, where nobody can be asked."""
    return answers[0]


@dataclass
class Laboratory:
    """The files of a case, each with its kind, and what is doubtful about their choice."""

    files: list[Taken]
    ask: Ask = first_choice
    findings: list[Finding] = field(default_factory=list)

    def of(self, *kinds: str) -> list[Taken]:
        """Return the files of some kinds, in their order."""
        return [file for file in self.files if file.kind in kinds]

    def leave_out(self, files: Sequence[Taken], why: str) -> None:
        """Take files out of the case."""
        for file in files:
            unused = replace(file, kind=UNUSED, why=f"{file.kind}; {why}")
            self.files[self.files.index(file)] = unused

    def choose(self, what: str, groups: Sequence[list[Taken]], effect: float) -> None:
        """Keep one of several groups of files: that of the caller, or else the one he chooses."""
        names = [" and ".join(file.path.name for file in group) for group in groups]
        kept = [at for at, group in enumerate(groups) if any(file.by_caller for file in group)]
        if len(groups) > 1 and not kept:
            kept = [names.index(self.ask(f"Which is the {what}?", names))]
            others = [name for at, name in enumerate(names) if at not in kept]
            text = f"{names[kept[0]]} is taken as the {what}, not {' or '.join(others)}: --as "
            if self.ask is first_choice:
                self.findings.append(assumption(effect, f"{text}states another"))
        for at, group in enumerate(groups):
            if kept and at != kept[0]:
                cure = f"--as {group[0].kind} {group[0].path.name} takes it"
                self.leave_out(group, f"the {what} is {names[kept[0]]}; {cure}")

    def choose_surface(self) -> None:
        """Keep one map or spectrum, or the profiles, of which all state their units, or none."""
        profiles = self.of("profile")
        with_units = [
            file for file in profiles if file.by_caller or not file.missing.keys() - {"channel"}
        ]
        bare = [file for file in profiles if with_units and file not in with_units]
        self.leave_out(bare, "it names no unit, unlike others; --as profile takes it")
        groups = [*([file] for file in self.of("map")), self.of("profile")]
        groups += [[file] for file in self.of("spectrum")]  # heights know more
        self.choose("surface", [group for group in groups if group], OF_ANOTHER_CASE)

    def choose_rubber(self, keys: FileKeys) -> None:
        """Keep the sweeps, which are joined, or one other file.

        A curve is likelier with shift factors, and a file to whose name others belong.
        """
        rubbers = self.of(*RUBBERS)
        joined = [file for file in rubbers if joinable(file, keys.layout)]
        groups = [joined] * bool(joined) + [[file] for file in rubbers if file not in joined]
        first = "master-curve" if self.of("shift") else RUBBERS[0]
        others = self.of("shift", "strain-sweep", "friction")

        def likelihood(group: list[Taken]) -> tuple[bool, int, int]:
            common = sum(_in_common(file.path, group[0].path)[0] > 0 for file in others)
            return group[0].kind != first, RUBBERS.index(group[0].kind), -common

        groups.sort(key=likelihood)
        alike = len({group[0].kind for group in groups}) < len(groups)
        self.choose("rubber", groups, OF_ANOTHER_CASE if alike else BY_A_FACTOR)

    def choose_companion(self, kind: str, rivals: Sequence[Taken]) -> None:
        """Keep the files of a kind that belong to the rubber; but for strain sweeps one.

        `rivals` are all files of rubbers, those left out, too.
        """
        files, rubbers = [file for file in self.of(kind) if not file.by_caller], self.of(*RUBBERS)
        if files and rubbers:
            common = [_in_common(file.path, rubbers[0].path) for file in files]
            nearest = [max(_in_common(file.path, r.path)[0] for r in rivals) for file in files]
            each = zip(files, common, nearest, strict=True)
            far = [f for f, near, most in each if near < max(common) or near[0] < most]
            self.leave_out(far, f"by its name not of {rubbers[0].path.name}")
        if kind != "strain-sweep":
            self.choose(kind, [[file] for file in self.of(kind)], BY_A_FACTOR)


def _in_common(path: Path, other: Path) -> tuple[int, int]:
    """Return how many words two names of files have in common, and letters at their start."""
    words = [set(re.split(r"[\W_]+", name.stem.lower())) for name in (path, other)]
    letters = takewhile(lambda pair: pair[0] == pair[1], zip(path.stem, other.stem, strict=False))
    return len(words[0] & words[1]), len(list(letters))


def all_taken(
    files: Sequence[str | Path], keys: FileKeys, kinds: Mapping[str | Path, str]
) -> list[Taken]:
    """Return what files, and those of folders, are taken for; `kinds` are stated kinds of files."""
    folders = [Path(file) for file in files]
    paths = [p for file in folders for p in (sorted(file.glob("[!.]*")) or [file])]
    by_path = {}
    for file, kind in kinds.items():
        path = next((p for p in paths if Path(file) in (p, Path(p.name))), Path(file))
        paths += [path] if path not in paths else []
        by_path[path] = kind
    return [
        replace(take(path, keys, by_path.get(path)), by_caller=path in by_path) for path in paths
    ]


def laboratory(
    files: Sequence[str | Path],
    keys: FileKeys,
    kinds: Mapping[str | Path, str] = MappingProxyType({}),
    ask: Ask = first_choice,
) -> Laboratory:
    """Return the files, and those of folders, each with its kind, of which one case can be made.

    `kinds` are stated kinds of files. Raises `InputError` for an unknown kind, and the refusal of a
    file that is named and cannot be used.
    """
    lab = Laboratory(all_taken(files, keys, kinds), ask)
    named = [file for file in lab.files if file.by_caller or file.path in map(Path, files)]
    for file in named:
        if file.refusal:
            if lab.of(*SURFACES) and not lab.of(*RUBBERS):
                open_rubber([file.path], keys.layout)  # raises why there are no moduli in it
            raise file.refusal
    lab.leave_out([file for file in lab.of(*RUBBERS) if file.refusal], "not readable")
    lab.choose_surface()
    rivals = lab.of(*RUBBERS)
    lab.choose_rubber(keys)
    for kind in ("shift", "strain-sweep", "friction"):
        lab.choose_companion(kind, rivals)
    return lab
