"""The form of the package: what each package may use, and names that stand in one place."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

import gripscale
from tests.samples import ROOT

PACKAGE = Path(gripscale.__file__).parent
FRONT_ENDS = {"case_file", "cli", "app", "reproduction"}
"""Packages that know a case file."""


@cache
def modules() -> dict[str, ast.Module]:
    """Return the modules of the package by their dotted names."""
    trees = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        name = ".".join(("gripscale", *(part for part in parts if part != "__init__")))
        trees[name] = ast.parse(path.read_text(encoding="utf-8"))
    return trees


def imported(name: str, statements: Iterable[ast.AST]) -> Iterator[str]:
    """Yield modules that statements of `name` import."""
    for node in statements:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules())
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module in modules():
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in modules() else str(node.module)


def at_import(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements of a module outside of its functions."""
    for node in ast.iter_child_nodes(tree):
        if not isinstance(node, ast.FunctionDef):
            yield node
            yield from at_import(node)


def public_names(tree: ast.Module) -> Iterator[str]:
    """Yield the public functions, classes and constants that a module defines."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names = [node.name]
        elif isinstance(node, ast.Assign):
            names = [leaf.id for target in node.targets for leaf in leaves(target)]
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names = [node.target.id]
        else:
            continue
        yield from (name for name in names if not name.startswith("_"))


def leaves(target: ast.expr) -> list[ast.Name]:
    """Return the names that an assignment gives."""
    return [node for node in ast.walk(target) if isinstance(node, ast.Name)]


DECLARATIONS = {"KINDS", "COMMANDS", "FORMS"}
"""Names by which every package of a question says what it holds."""


def test_a_public_name_stands_in_one_module() -> None:
    homes = defaultdict(list)
    for module, tree in modules().items():
        for name in set(public_names(tree)) - DECLARATIONS:
            homes[name].append(module)
    assert {name: at for name, at in homes.items() if len(at) > 1} == {}


def test_only_front_ends_know_a_case_file() -> None:
    """Of the questions the commands and what they share; a case imports it when it is saved."""
    uses = {
        f"{module} -> {other}"
        for module, tree in modules().items()
        if module.split(".")[1:2] not in [[name] for name in FRONT_ENDS]
        if module.split(".")[-1] not in ("command", "terminal")
        for other in imported(module, at_import(tree))
        if other.split(".")[1:2] == ["case_file"]
    }
    assert uses == set()


def circles(arrows: Mapping[str, set[str]]) -> dict[str, list[str]]:
    """Return what uses itself through others, with what it uses."""
    free: set[str] = set()
    while ready := {name for name, uses in arrows.items() if name not in free and uses <= free}:
        free |= ready
    return {name: sorted(uses - free) for name, uses in arrows.items() if name not in free}


def test_no_module_imports_itself_through_others() -> None:
    """Nor for types; within a function an object may import what draws or writes it."""
    arrows = {
        name: set(imported(name, at_import(tree))) - {name, "gripscale"}
        for name, tree in modules().items()
    }
    assert circles(arrows) == {}


def test_every_package_uses_only_packages_below() -> None:
    """A folder or a file of the package uses none that uses it."""
    arrows: dict[str, set[str]] = defaultdict(set)
    for name, tree in modules().items():
        package = name.split(".")[1:2]
        if package:
            used = {
                other.split(".")[1] for other in imported(name, at_import(tree)) if "." in other
            }
            arrows[package[0]] |= used - {*package}
    assert circles(arrows) == {}


def test_pages_and_data_of_the_package_are_links() -> None:
    """One text in a clone; a wheel holds copies."""
    for folder in (PACKAGE / "pages", PACKAGE / "case_file" / "data"):
        copies = [path.name for path in folder.rglob("*.*") if not path.is_symlink()]
        assert copies == []


def test_charts_and_reports_import_no_question() -> None:
    """Not within a function either, nor for types."""
    uses = set()
    for module, tree in modules().items():
        if module.split(".")[1:2] in (["charts"], ["report"]):
            for node in ast.walk(tree):
                if isinstance(node, ast.Import | ast.ImportFrom):
                    words = ast.unparse(node)
                    uses |= {f"{module}: {words}"} if "questions" in words else set()
    assert uses == set()


def refused_names() -> set[str]:
    """Return the pronouns and participles that CONTRIBUTING lists as never a name."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    sentence = re.search(r"These words are never a name[^:]*: (.*?)\.\n", text, re.DOTALL)
    assert sentence is not None
    return set(re.findall(r"`(\w+)`", sentence[1]))


def test_no_pronoun_or_participle_is_a_name() -> None:
    refused, named = refused_names(), set()
    assert {"one", "found", "told", "such"} <= refused
    for module, tree in modules().items():
        for node in ast.walk(tree):
            name = ""
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                name = node.name
            elif isinstance(node, ast.arg):
                name = node.arg
            elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                name = node.id
            if name.strip("_") in refused:
                named.add(f"{module}: {name}")
    assert named == set()


READERS = {
    "measured files": "io.cells io.text_table rubber.blocks surface.header surface.height_grids "
    "surface.read_spectrum surface.text_files",
    "titles of columns": "experiment.measured_friction rubber.columns rubber.prony "
    "rubber.shift_fit rubber.strain_sweeps",
    "names of files and paths": "app.case case_file.laboratory case_file.save "
    "questions.answer.charts questions.inputs.page",
    "what is typed": "app.forms questions.vary.axis surface.cut_off",
    "quantities with units": "core.units case_file.keys",
    "TOML": "case_file.folder case_file.read",
    "Markdown, SVG, marks of code, equations of labels": "cli.docs report.equations io.table "
    "charts.chart",
    "other programs": "export.programs export.tables",
}
"""What regular expressions are for: the texts of people, files and formats."""


def test_no_regular_expression_reads_our_own_sentences() -> None:
    """What a sentence is about is data beside it: `Finding`, `Words`, attributes of an error."""
    users = {
        name.removeprefix("gripscale.")
        for name, tree in modules().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Import) and any(alias.name == "re" for alias in node.names)
    }
    assert users == set(" ".join(READERS.values()).split())
