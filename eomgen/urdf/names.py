"""Names of a URDF as names of the language: letters, digits and underscores, all different."""

import re
from unicodedata import normalize

from eomgen.spec.formula import RESERVED
from eomgen.spec.names import WORLD

MOST_CHARACTERS = 40  # the language has 60; prefixes and suffixes come on top


def identifier(name: str, noun: str) -> str:
    """A proper name as near to the given one as can be."""
    plain = normalize("NFKD", name).encode("ascii", "ignore").decode()
    word = re.sub("[^A-Za-z0-9_]+", "_", plain)
    if not re.match("_*[A-Za-z]", word):
        word = f"{noun}_{word}".rstrip("_")
    word = word[:MOST_CHARACTERS]
    return f"{word}_" if word in (*RESERVED, WORLD) else word


class Names:
    """The names given so far, all in one space."""

    def __init__(self) -> None:
        self.taken: set[str] = set()

    def new(self, wanted: str) -> str:
        """The wanted name, numbered where it is taken."""
        name, number = wanted, 1
        while name in self.taken:
            number += 1
            name = f"{wanted}_{number}"
        self.taken.add(name)
        return name

    def of(self, name: str, noun: str) -> str:
        """The name of a link or a joint."""
        return self.new(identifier(name, noun))
