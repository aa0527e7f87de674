"""What a user can get wrong: every fault says where, what, and what to write instead."""

from dataclasses import dataclass


@dataclass(frozen=True, order=True)
class Location:
    """A position in a text: line and column count from 1, code points not bytes."""

    file: str
    line: int
    column: int


@dataclass(frozen=True, order=True)
class Fault:
    """One mistake: its location, a stable code such as `E104`, one clear line, a remedy."""

    location: Location
    code: str
    message: str
    hint: str = ""
    source: str = ""  # the offending line of the file, for the caret


class EomgenError(Exception):
    """Base of everything that is the user's to mend; `exit_code` is what the shell sees."""

    exit_code = 2


class SpecError(EomgenError):
    """All mistakes of one spec file, in the order of their lines."""

    def __init__(self, faults: tuple[Fault, ...]) -> None:
        super().__init__("; ".join(f.message for f in faults))
        self.faults = tuple(sorted(faults))


class UsageError(EomgenError):
    """A wrong option, state file or template: one line that says what to do."""


class CheckError(EomgenError):
    """Something printed would not be true: the check's own words."""

    exit_code = 1
