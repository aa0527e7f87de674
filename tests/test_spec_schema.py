import copy
import subprocess
import sys

import pytest
import yaml
from bad_specs import BASE, SOLID
from spec_samples import CONSTRAINED, EVERYTHING, FREE, LINKED

from eomgen.spec.language import LANGUAGE, Either, Items, Leaf, Record, Table
from eomgen.spec.schema import schema

TYPES = {
    "object": dict, "array": list, "string": str, "number": (int, float), "integer": int,
    "boolean": bool, "null": type(None),
}  # fmt: skip
KEYWORDS = {  # all that the schema uses, so that the validator below sees everything
    "$schema", "title", "description", "type", "enum", "anyOf", "items", "minItems", "maxItems",
    "properties", "additionalProperties", "required", "minimum",
}  # fmt: skip


def accepts(rule, value):
    """A validator of the keywords that our schema uses (JSON Schema 2020-12)."""
    assert set(rule) <= KEYWORDS
    types = rule.get("type", list(TYPES))
    types = [types] if isinstance(types, str) else types
    fits = any(isinstance(value, TYPES[t]) for t in types)
    if isinstance(value, bool) and "boolean" not in types:
        fits = False
    checks = [fits, "enum" not in rule or value in rule["enum"]]
    if "anyOf" in rule:
        checks.append(any(accepts(r, value) for r in rule["anyOf"]))
    if isinstance(value, list):
        checks.append(rule.get("minItems", 0) <= len(value) <= rule.get("maxItems", len(value)))
        checks += [accepts(rule["items"], item) for item in value if "items" in rule]
    if isinstance(value, dict) and fits:
        checks += entries(rule, value)
    return all(checks)


def entries(rule, value):
    known, other = rule.get("properties", {}), rule.get("additionalProperties", True)
    yield set(rule.get("required", ())) <= set(value)
    for key, item in value.items():
        if key in known:
            yield accepts(known[key], item)
        else:
            yield accepts(other, item) if isinstance(other, dict) else other


def loaded(text):
    return yaml.safe_load(
        text.replace("[on", "['on'").replace("{on:", "{'on':").replace(" on:", " 'on':")
    )


@pytest.mark.parametrize("text", [*FREE.values(), *CONSTRAINED.values(), EVERYTHING, BASE, SOLID])
def test_schema_accepts_what_the_reader_accepts(text):
    assert accepts(schema(), loaded(text))


def without(path, key):
    """The sample, the map under the path, and what the key had, which is taken out."""
    document = copy.deepcopy(loaded(EVERYTHING))
    node = document
    for step in path:
        node = node[step]
    return document, node, node.pop(key)


@pytest.mark.parametrize(
    ("path", "key", "misspelt"),
    [
        ((), "gravity", "gravty"),
        (("bodies", "arm"), "mass", "mas"),
        (("bodies", "arm", "frame"), "angle", "angel"),
        (("springs", 0), "stiffness", "stifness"),
        (("parameters", "m"), "value", "valeu"),
        (("expect",), "dof", "dofs"),
    ],
)
def test_schema_refuses_a_misspelt_key(path, key, misspelt):
    document, node, value = without(path, key)
    node[misspelt] = value
    assert not accepts(schema(), document)
    node[key] = node.pop(misspelt)
    assert accepts(schema(), document)


@pytest.mark.parametrize(
    ("path", "key"), [((), "space"), (("bodies", "arm"), "mass"), (("forces", 0), "force")]
)
def test_schema_refuses_a_missing_key(path, key):
    document, _, _ = without(path, key)
    assert not accepts(schema(), document)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("space", "plan"),
        ("eom", 2),
        ("parameters", ["m"]),
        ("range", {"s": [1]}),
        ("bodies", {"a": {"mass": 1, "rod": ["A"]}}),
        ("expect", {"dof": "one"}),
        ("coordinates", {"s": {"role": "bound"}}),
    ],
)
def test_schema_refuses_a_wrong_value(key, value):
    assert not accepts(schema(), loaded(EVERYTHING) | {key: value})


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("holonomic: B = C", "holonom: B = C"),
        ("holonomic: B = C", "holonomic: [B, C]"),
        ("reaction: pin", "reaction: [pin]"),
        ("guess: {", "gues: {"),
        ("phi: 10 deg", "phi: [10 deg]"),
        ("role: free", "role: dependent"),
    ],
)
def test_schema_refuses_a_wrong_constraint(old, new):
    assert accepts(schema(), loaded(LINKED))
    assert not accepts(schema(), loaded(LINKED.replace(old, new)))


def test_schema_accepts_a_list_of_constraints():
    text = BASE + "constraints: [{holonomic: phi = 1, about: stuck}]\n"
    assert accepts(schema(), loaded(text))
    assert not accepts(schema(), loaded(text.replace("about", "abut")))


def test_every_key_is_described():
    def visit(form):
        match form:
            case Record(keys):
                for key in keys.values():
                    assert key.about
                    visit(key.form)
            case Either(forms):
                for inner in forms:
                    visit(inner)
            case Items(inner, _, _):
                visit(inner)
            case Table(inner, keys):
                visit(inner)
                visit(Record(keys))
            case Leaf():
                pass

    visit(LANGUAGE)
    assert schema()["properties"]["gravity"]["description"]
    assert schema()["$schema"].endswith("2020-12/schema")


def test_schema_and_report_do_without_sympy():
    code = "import eomgen.spec.schema, eomgen.spec.report, sys; sys.exit('sympy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
