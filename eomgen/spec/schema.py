"""The JSON Schema (2020-12) of the language, made from the table that the reader checks with."""

from collections.abc import Mapping
from typing import Any

from eomgen.spec.language import LANGUAGE, Either, Form, Items, Key, Leaf, Record, Table

Schema = dict[str, Any]
SCALAR: Schema = {"type": ["string", "number"]}
KINDS: dict[str, Schema] = {
    "text": {"type": ["string", "number", "boolean"]},
    "name": {"type": "string"},
    "formula": SCALAR,
    "relation": {"type": "string"},
    "quantity": {"type": ["string", "number", "null"]},
    "unit": {"type": ["string", "number", "null"]},
    "boolean": {"type": "boolean"},
    "integer": {"type": "integer", "minimum": 0},
}


def schema() -> Schema:
    """The schema of a whole spec."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "eomgen specification of a mechanical system",
        **of(LANGUAGE),
    }


def of(form: Form) -> Schema:
    """The schema of one form."""
    match form:
        case Leaf(kind, choices):
            return _choice(choices) if choices else dict(KINDS[kind])
        case Either(forms):
            return {"anyOf": [of(f) for f in forms]}
        case Items(inner, least, most):
            bounds = {"minItems": least} | ({"maxItems": most} if most else {})
            return {"type": "array", "items": of(inner), **bounds}
        case Table(inner, keys):
            return {"type": "object", **_properties(keys), "additionalProperties": of(inner)}
        case Record(keys):
            return _record(dict(keys))


def _choice(choices: tuple[str, ...]) -> Schema:
    """A fixed word; a version number is a number for an editor."""
    return {"enum": [int(c) if c.isdigit() else c for c in choices]}


def _properties(keys: Mapping[str, Key]) -> Schema:
    """What is said of each fixed key."""
    found = {name: {"description": key.about, **of(key.form)} for name, key in keys.items()}
    return {"properties": found} if found else {}


def _record(keys: dict[str, Key]) -> Schema:
    required = [name for name, key in keys.items() if key.required]
    return {
        "type": "object",
        **_properties(keys),
        "additionalProperties": False,
        **({"required": required} if required else {}),
    }
