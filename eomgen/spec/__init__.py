"""The way in: the text of a spec file -> a frozen `Model`, or every fault of the file."""

from eomgen.spec.document import read

__all__ = ["read"]
