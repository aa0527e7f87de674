"""Code flows one way: each room imports only from the rooms listed for it."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1] / "eomgen"

RECORDS = {"errors", "dimension", "model", "program", "__init__"}
ALLOWED: dict[str, set[str]] = {
    "__init__": set(),
    "errors": set(),
    "cache_folder": set(),
    "dimension": set(),
    "model": {"dimension"},
    "program": set(),
    "latex_name": {"errors"},
    "spec": {"errors", "dimension", "latex_name", "model", "wanted"},
    "algebra": {"errors", "program", "model"},
    "mechanics": RECORDS | {"algebra"},
    "interpreter": RECORDS | {"algebra"},
    "compile": RECORDS | {"algebra", "mechanics", "compile_variables"},
    "compile_variables": RECORDS | {"mechanics", "spec"},
    "compile_linked": RECORDS | {"algebra", "mechanics", "compile"},
    "compile_reactions": RECORDS | {"algebra", "mechanics", "compile"},
    "compile_contacts": RECORDS | {"algebra", "mechanics", "compile"},
    "compile_watch": RECORDS | {"algebra", "mechanics", "compile"},
    "analysis": RECORDS | {"algebra", "mechanics", "compile"},
    "checks": RECORDS | {"algebra", "mechanics", "compile", "analysis", "formulation"},
    "functions": RECORDS | {"algebra", "analysis", "checks", "compile", "mechanics", "render"},
    "wanted": {"errors"},
    "formulation": RECORDS
    | {"compile_watch"}
    | {"wanted", "algebra", "analysis", "compile", "mechanics"},
    "reactions": RECORDS | {"algebra", "formulation", "mechanics"},
    "study_linked": RECORDS
    | {
        "analysis",
        "checks",
        "compile",
        "compile_contacts",
        "compile_watch",
        "wanted",
        "compile_linked",
        "formulation",
        "mechanics",
    },
    "study": RECORDS
    | {"algebra", "wanted", "spec", "mechanics", "compile", "checks", "study_linked"},
    "evaluate_joints": RECORDS
    | {"compile", "compile_reactions", "evaluate", "mechanics", "states"},
    "evaluate_contacts": RECORDS
    | {"compile", "compile_contacts", "evaluate", "mechanics", "states"},
    "evaluate_linked": RECORDS
    | {"compile_contacts", "compile_watch", "evaluate_contacts"}
    | {"algebra", "evaluate", "interpreter", "reactions", "states", "study_linked"},
    "answers": RECORDS
    | {"evaluate_joints", "evaluate", "evaluate_linked", "functions", "states", "study"},
    "integrators": {"errors", "program"},
    "compile_flow": RECORDS | {"algebra", "checks", "compile", "compile_contacts", "mechanics"},
    "compile_steps": RECORDS
    | {"algebra", "checks", "compile", "functions", "integrators", "mechanics"},
    "compile_places": RECORDS | {"algebra", "compile", "mechanics", "render"},
    "stepping": RECORDS | {"compile", "compile_steps", "integrators", "study"},
    "simulate_setup": RECORDS
    | {"checks", "compile_contacts", "compile_flow", "compile_steps", "evaluate"}
    | {"evaluate_linked", "integrators", "mechanics", "numerics", "states", "stepping", "study"},
    "simulate_method": RECORDS | {"integrators", "numerics", "simulate_setup", "study"},
    "simulate": RECORDS | {"integrators", "numerics", "simulate_method", "simulate_setup"},
    "simulate_table": RECORDS | {"numerics", "simulate_setup"},
    "simulate_report": RECORDS
    | {"numerics", "simulate", "simulate_method", "simulate_setup", "simulate_table"},
    "simulate_run": RECORDS
    | {"compile_places", "numerics", "render", "simulate", "simulate_method", "simulate_report"}
    | {"simulate_setup", "simulate_table", "study"},
    "stability": RECORDS
    | {"analysis", "chart", "checks", "compile_steps", "evaluate", "integrators", "mechanics"}
    | {"numerics", "render", "simulate_method", "simulate_setup", "states", "stepping", "study"},
    "cli_stability": {"cli_common", "errors", "files", "stability", "wanted"},
    "cli_simulate": {"cli_common", "errors", "files", "simulate_run", "wanted"},
    "chart": RECORDS
    | {"compile_steps", "formulation", "integrators", "numerics", "render", "simulate"}
    | {"simulate_method", "simulate_setup", "stepping", "study", "wanted"},
    "charting": RECORDS | {"chart", "files", "simulate_setup", "spec", "study"},
    "cli_chart": {"charting", "cli_common", "errors", "files"},
    "render": RECORDS | {"cache_folder", "algebra", "latex_name", "mechanics", "integrators"},
    "numerics": RECORDS | {"cache_folder", "render", "interpreter", "integrators"},
    "states": RECORDS | {"mechanics"},
    "evaluate": RECORDS | {"mechanics", "compile", "interpreter", "render", "numerics", "states"},
    "files": {"errors"},
    "shelf": {"errors", "files", "render", "spec"},
    "rest": RECORDS | {"analysis", "mechanics", "render", "spec", "states"},
    "output_links": {"analysis", "compile", "formulation", "mechanics", "render"},
    "outputs": RECORDS
    | {"checks", "functions", "integrators", "output_links", "analysis", "mechanics", "render"}
    | {"stability"}
    | {"spec", "stepping", "study"},
    "cli_common": {"errors", "files", "functions", "outputs", "render", "spec", "study", "wanted"},
    "precision": RECORDS
    | {"algebra", "analysis", "checks", "evaluate", "formulation", "interpreter", "mechanics"}
    | {"numerics", "render", "study"},
    "cli_precision": {"precision", "spec", "study"},
    "cli_regressor": {"cli_common", "files", "functions", "study", "wanted"},
    "urdf": {"__init__", "errors", "spec"},
    "cli_import": {"cli_common", "errors", "files", "shelf", "spec", "urdf"},
    "cli": {
        "__init__",
        "cli_import",
        "cli_precision",
        "cli_chart",
        "cli_common",
        "cli_simulate",
        "cli_stability",
        "cli_regressor",
        "errors",
        "files",
        "wanted",
        "outputs",
        "study",
        "answers",
        "rest",
        "shelf",
        "spec",
    },
}


def room(path: Path) -> str:
    """The top-level module or package that a file belongs to."""
    first = path.relative_to(ROOT).parts[0]
    return first.removesuffix(".py")


def imported_rooms(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "eomgen":
            parts = node.module.split(".")
            found |= {parts[1]} if len(parts) > 1 else {alias.name for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {
                (alias.name.split(".") + ["__init__"])[1]
                for alias in node.names
                if alias.name.split(".")[0] == "eomgen"
            }
    return {"__init__" if name == "__version__" else name for name in found}


FILES = sorted(ROOT.rglob("*.py"))


def test_every_room_is_in_the_table() -> None:
    assert {room(f) for f in FILES} <= ALLOWED.keys()


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_flow_one_way(path: Path) -> None:
    own = room(path)
    back = imported_rooms(path) - ALLOWED[own] - {own}
    assert not back, f"{path.name} imports from {sorted(back)}, which stand to the right of {own}"


def test_no_circle_of_rooms() -> None:
    """The table itself is an order: repeatedly take away what imports nothing that is left."""
    left = {name: {n for n in wanted if n != name} for name, wanted in ALLOWED.items()}
    while left:
        free = [name for name, wanted in left.items() if not wanted & left.keys()]
        assert free, f"these rooms import each other: {sorted(left)}"
        for name in free:
            del left[name]


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_files_stay_small(path: Path) -> None:
    assert len(path.read_text(encoding="utf-8").splitlines()) <= 400
