"""The language as one table: every key, what it means and what shape its value has.

The reader checks keys with it and the JSON Schema is made from it.
"""

from collections.abc import Mapping as Map
from dataclasses import dataclass, field

from eomgen.wanted import FORMULATIONS, INTEGRATORS


@dataclass(frozen=True)
class Leaf:
    """One scalar: text, name, formula, quantity, unit, relation, boolean, integer or choice."""

    kind: str
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Items:
    """A list; `least` and `most` bound its length, 0 for no bound."""

    of: "Form"
    least: int = 0
    most: int = 0


@dataclass(frozen=True)
class Table:
    """A map from the author's names to values; a few keys may mean something of their own."""

    of: "Form"
    keys: "Map[str, Key]" = field(default_factory=dict)


@dataclass(frozen=True)
class Record:
    """A map with fixed keys."""

    keys: Map[str, "Key"]


@dataclass(frozen=True)
class Either:
    """One form for each shape of node: scalar, list, map."""

    forms: tuple["Form", ...]


Form = Leaf | Items | Table | Record | Either


@dataclass(frozen=True)
class Key:
    """One key: what it means, what its value is, whether it must be there."""

    about: str
    form: Form
    required: bool = False


TEXT, NAME, UNIT = Leaf("text"), Leaf("name"), Leaf("unit")
FORMULA, QUANTITY, RELATION = Leaf("formula"), Leaf("quantity"), Leaf("relation")
BOOLEAN, INTEGER = Leaf("boolean"), Leaf("integer")

VECTOR = Either((FORMULA, Items(FORMULA, least=1)))
PAIR = Items(NAME, least=2, most=2)
TENSOR = Either((FORMULA, Items(VECTOR, least=1)))
QUATERNION = Record({"quaternion": Key("a coordinate declared as `quaternion`", NAME, True)})
ROTATIONS = (
    "rotations, body-fixed, left to right: [[z, psi], [x, theta]], or {quaternion: e} among them"
)
TURN = Either((Items(VECTOR, least=2, most=2), QUATERNION))
TURNS = Either((Items(TURN, least=1), QUATERNION))

LATEX = Key("LaTeX of the symbol, instead of what its spelling gives", TEXT)
ABOUT = Key("one line for people", TEXT)
SI = Key("SI unit, such as m, rad, N*m", UNIT)
POSITIVE = Key("true: it is known to be positive", BOOLEAN)
DESCRIBED = {"unit": SI, "latex": LATEX, "about": ABOUT}


def _described(key: str, key_about: str) -> Either:
    record = Record({key: Key(key_about, FORMULA, required=True), **DESCRIBED})
    return Either((FORMULA, record))


PARAMETER = Either(
    (
        QUANTITY,
        Record(
            {
                "value": Key("number with unit (2 kg), or a formula of parameters", QUANTITY),
                "unit": Key("unit of the value, where the value states none", UNIT),
                "latex": LATEX,
                "about": ABOUT,
                "positive": POSITIVE,
            }
        ),
    )
)

COORDINATE = Either(
    (
        UNIT,
        Record(
            {
                "role": Key(
                    "beside constraints: free (wanted as independent) or linked (dependent); "
                    "once one is linked, the others are free",
                    Leaf("choice", ("free", "linked")),
                ),
                **DESCRIBED,
                "positive": POSITIVE,
            }
        ),
    )
)

FRAME = Record(
    {
        "on": Key("the body that carries this frame; the world if absent", NAME),
        "at": Key("origin, in the axes of `on`; its origin if absent", VECTOR),
        "angle": Key("rotation in the plane", FORMULA),
        "turn": Key(ROTATIONS, TURNS),
    }
)

BODY = Record(
    {
        "mass": Key("mass", FORMULA, required=True),
        "at": Key("position of the mass centre", VECTOR),
        "angle": Key("rotation in the plane", FORMULA),
        "turn": Key(ROTATIONS, TURNS),
        "inertia": Key(
            "about the mass centre, in body axes: a number in the plane; [a, b, c], "
            "[Ixx, Iyy, Izz, Ixy, Ixz, Iyz] or three rows in solid space",
            TENSOR,
        ),
        "rod": Key("a uniform rod between two points", PAIR),
        "frame": Key("a frame on another body", FRAME),
        "com": Key("mass centre in the axes of the frame", VECTOR),
        "about": ABOUT,
    }
)

BETWEEN = Key("two points or bodies", PAIR)
ALONG = Key("the elongation as a formula in the coordinates", FORMULA)

SPRING = Record(
    {
        "between": BETWEEN,
        "along": ALONG,
        "stiffness": Key("force per elongation", FORMULA),
        "free_length": Key("length (or value of `along`) without force", FORMULA),
        "energy": Key("potential energy as a formula of the elongation s", FORMULA),
        "law": Key("force as a formula of the elongation s, pulling when positive", FORMULA),
    }
)

DAMPER = Record(
    {
        "between": BETWEEN,
        "along": ALONG,
        "damping": Key("force per rate", FORMULA),
        "law": Key("force as a formula of the rate v, against it when positive", FORMULA),
    }
)

FORCE = Record(
    {
        "on": Key("point or body that the force acts on", NAME),
        "from": Key("point or body that takes the reaction", NAME),
        "along": Key("instead of `on`: a formula in the coordinates that it increases", FORMULA),
        "force": Key("components; along a formula a scalar", VECTOR, required=True),
        "in": Key("world (default) or the body whose axes the components are in", NAME),
    }
)

MOMENT = Record(
    {
        "on": Key("body that the moment acts on", NAME, required=True),
        "from": Key("body that takes the reaction", NAME),
        "moment": Key("a scalar in the plane, three components in solid space", VECTOR, True),
        "in": Key("world (default) or the body whose axes the components are in", NAME),
    }
)

CONSTRAINT = Record(
    {
        "holonomic": Key(
            "left = right between positions and t, or two points or bodies set equal: C = Cr",
            RELATION,
        ),
        "nonholonomic": Key("left = right between rates, linear in them", RELATION),
        "unilateral": Key("left >= right (or <=) between positions and t", RELATION),
        "reaction": Key("name under which the constraint force is asked for", NAME),
        "restitution": Key(
            "of a unilateral one: rebound over approach speed, from 0 to 1", FORMULA
        ),
        "friction": Key(
            "of a surface, unilateral or holonomic: Coulomb's coefficient, not negative", FORMULA
        ),
        "latex": LATEX,
        "about": ABOUT,
    }
)

EQUATIONS = Either((RELATION, Items(RELATION), Table(RELATION)))
GUESS = "beside constraints: about where coordinates and rates are that the constraints decide"
INITIAL = {"guess": Key(GUESS, Table(QUANTITY))}
INITIAL_VALUE = Either((QUANTITY, Items(QUANTITY, least=4, most=4)))  # four of a quaternion
EQUILIBRIUM = Either((Table(QUANTITY), Items(Table(QUANTITY))))

SIMULATION = Record(
    {
        "method": Key("the integrator", Leaf("choice", INTEGRATORS)),
        "step": Key("of a method with fixed steps", QUANTITY),
        "formulation": Key(
            "of the equations; a free scene has `minimal`", Leaf("choice", FORMULATIONS)
        ),
    }
)

LANGUAGE = Record(
    {
        "eom": Key("version of the language", Leaf("choice", ("1",)), required=True),
        "system": Key("title; text, or language to text", Either((TEXT, Table(TEXT))), True),
        "space": Key(
            "length of vectors: line 1, plane 2, solid 3",
            Leaf("choice", ("line", "plane", "solid")),
            required=True,
        ),
        "gravity": Key("acceleration vector; 0 for none", VECTOR),
        "parameters": Key("constants", Table(PARAMETER)),
        "coordinates": Key("generalized coordinates", Table(COORDINATE), required=True),
        "speeds": Key(
            "quasi-velocities, linear in the rates", Table(_described("formula", "in the rates"))
        ),
        "prescribed": Key(
            "known functions of time", Table(_described("formula", "in t and parameters"))
        ),
        "inputs": Key(
            "unknown when the equations are derived", Table(Either((UNIT, Record(DESCRIBED))))
        ),
        "points": Key(
            "named places",
            Table(
                Either(
                    (
                        *VECTOR.forms,
                        Record(
                            {
                                "on": Key("the body it is fixed to", NAME, required=True),
                                "at": Key("in the axes of that body", VECTOR, required=True),
                            }
                        ),
                    )
                )
            ),
        ),
        "bodies": Key("what has mass", Table(BODY)),
        "springs": Key("springs", Either((Items(SPRING), Table(SPRING)))),
        "dampers": Key("dampers", Either((Items(DAMPER), Table(DAMPER)))),
        "forces": Key("forces", Either((Items(FORCE), Table(FORCE)))),
        "moments": Key("moments", Either((Items(MOMENT), Table(MOMENT)))),
        "constraints": Key(
            "relations that the coordinates keep; each one of 'holonomic', 'nonholonomic', "
            "'unilateral'",
            Either((Items(CONSTRAINT), Table(CONSTRAINT))),
        ),
        "energy": Key(
            "extra terms, or the whole model",
            Record(
                {
                    "kinetic": Key("kinetic energy", FORMULA),
                    "potential": Key("potential energy", FORMULA),
                    "dissipation": Key("dissipation function, half the power lost", FORMULA),
                }
            ),
        ),
        "initial": Key("initial values of coordinates and rates", Table(INITIAL_VALUE, INITIAL)),
        "range": Key(
            "the region in which the scene moves", Table(Items(QUANTITY, least=2, most=2))
        ),
        "outputs": Key("named formulas", Table(_described("formula", "the formula"))),
        "simulate": Key("how `eomgen simulate` runs it, unless told otherwise", SIMULATION),
        "expect": Key(
            "the author's claims, checked",
            Record(
                {
                    "dof": Key("degrees of freedom", INTEGER),
                    "equations": Key("equations of motion, left = right", EQUATIONS),
                    "equilibrium": Key("coordinates at rest", EQUILIBRIUM),
                    "conserved": Key(
                        "formulas that stay constant", Either((FORMULA, Items(FORMULA)))
                    ),
                    "kinetic": Key("kinetic energy", FORMULA),
                    "potential": Key("potential energy, up to a constant", FORMULA),
                }
            ),
        ),
    }
)
