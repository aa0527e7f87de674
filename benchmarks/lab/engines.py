"""Pinocchio and MuJoCo in loops of their own language, against the libraries of their wheels."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lab.build import NATIVE, Source
from lab.contestants import Contestant
from lab.frames import Array, Placed, aligned
from lab.trees import Link, Tree

NATIVE_SOURCES = Path(__file__).parent / "native"
C = {"gcc": ("gcc", "-O2")}  # of the loop only, the library is as it comes
CPP = {  # gcc makes Pinocchio half as fast again
    "clang++ -O3 native": ("clang++", "-std=c++17", *NATIVE, "-DNDEBUG"),
}
PINOCCHIO_DEFINES = (
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
)
EIGEN = (Path("/usr/include/eigen3"), Path("/usr/local/include/eigen3"))


def _package(name: str) -> Path | None:
    """The folder of an installed package."""
    found = importlib.util.find_spec(name)
    if found is None or not found.submodule_search_locations:
        return None
    return Path(next(iter(found.submodule_search_locations)))


def _numbers(values: Array) -> str:
    return " ".join(repr(float(v)) for v in np.ravel(values))


def _joint(parent: int, kind: str, link: Placed) -> str:
    """A line for `setup` of pinocchio_run.cpp."""
    body = (link.base, link.place, np.array(link.mass), link.com, link.inertia)
    return f"{parent + 1} {kind} " + " ".join(_numbers(part) for part in body)


def _kind(link: Placed) -> str:
    return ("slide_" if link.slides else "turn_") + "xyz"[int(link.axis.argmax())]


def _one_by_one(tree: Tree) -> str:
    lines = [_joint(link.parent, _kind(link), link) for link in aligned(tree)]
    return "\n".join([_numbers(np.array([float(g) for g in tree.gravity])), *lines])


def _base_as_two(tree: Tree) -> str | None:
    """The first six links as a translation and turns about z, y, x; None where they are not."""
    links = aligned(tree)
    if [_kind(link) for link in links[:6]] != [
        *("slide_x", "slide_y", "slide_z"),
        *("turn_z", "turn_y", "turn_x"),
    ]:
        return None
    lines = [_joint(-1, "translation", links[0]), _joint(0, "zyx", links[5])]
    lines += [_joint(link.parent - 4, _kind(link), link) for link in links[6:]]
    return "\n".join([_numbers(np.array([float(g) for g in tree.gravity])), *lines])


def pinocchio(tree: Tree) -> Iterator[Contestant]:
    """Its `aba` in both conventions, the free body as six joints and as two."""
    wheel = _package("pinocchio")
    eigen = next((folder for folder in EIGEN if folder.is_dir()), None)
    if wheel is None or eigen is None:
        return
    headers = next(p for p in wheel.parents if (p / "include").is_dir()) / "include"
    text = (NATIVE_SOURCES / "pinocchio_run.cpp").read_text(encoding="utf-8")
    flags = (*PINOCCHIO_DEFINES, f"-I{headers}", f"-I{eigen}")
    source = Source({"run.cpp": text}, "run.cpp", flags=flags)
    variants = {"six joints": _one_by_one(tree), "base as two joints": _base_as_two(tree)}
    for how, lines in variants.items():
        for convention in ("local", "world"):
            if lines is not None:
                yield Contestant(
                    "Pinocchio, clang",
                    f"{convention}, {how}",
                    source,
                    driven=False,
                    text=lines,
                    function=f"run_{convention}",
                    compilers=CPP,
                )


def _mjcf_body(link: Link, joints: list[Link], children: str) -> str:
    """A body with its joints, and the bodies on it."""
    place = " ".join(str(float(v)) for v in joints[0].place)
    lines = [f'<body pos="{place}">']
    for joint in joints:
        kind = "slide" if joint.joint == "slide" else "hinge"
        lines.append(f'<joint type="{kind}" axis="{" ".join(map(str, joint.axis))}"/>')
    inertia = [float(v) or (1e-14 if i < 3 else 0.0) for i, v in enumerate(link.inertia)]
    com = " ".join(str(float(v)) for v in link.com)
    full = " ".join(repr(v) for v in inertia)
    lines.append(f'<inertial mass="{float(link.mass)!r}" pos="{com}" fullinertia="{full}"/>')
    return "\n".join([*lines, children, "</body>"])


def mjcf(tree: Tree) -> str:
    """The tree for MuJoCo; massless links are further joints of the body behind them.

    A point mass gets 1e-14 kg m^2, the least that MuJoCo takes.
    """
    bodies: dict[int, str] = {}
    for i in reversed(range(len(tree.links))):
        link = tree.links[i]
        if not link.mass:
            continue
        joints = [link]
        parent = link.parent
        while parent >= 0 and not tree.links[parent].mass:
            joints.insert(0, tree.links[parent])
            parent = tree.links[parent].parent
        bodies[parent] = _mjcf_body(link, joints, bodies.pop(i, "")) + bodies.get(parent, "")
    gravity = " ".join(str(float(g)) for g in tree.gravity)
    return f"""<mujoco><compiler angle="radian" balanceinertia="false"/>
<option gravity="{gravity}"><flag contact="disable" constraint="disable"/></option>
<worldbody>{bodies[-1]}</worldbody></mujoco>"""


def mujoco(tree: Tree) -> Iterator[Contestant]:
    """`mj_forward` without contacts and constraints."""
    wheel = _package("mujoco")
    library = None if wheel is None else next(wheel.glob("libmujoco.so*"), None)
    if library is None:
        return
    text = (NATIVE_SOURCES / "mujoco_run.c").read_text(encoding="utf-8")
    source = Source(
        {"run.c": text},
        "run.c",
        flags=(f"-I{wheel}/include",),
        libraries=(str(library), f"-Wl,-rpath,{wheel}", "-lm"),
    )
    yield Contestant("MuJoCo", "mj_forward", source, driven=False, text=mjcf(tree), compilers=C)
