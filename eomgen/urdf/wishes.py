"""How a robot is imported."""

from dataclasses import dataclass
from decimal import Decimal


@dataclass(frozen=True)
class Wishes:
    """What the user asks for."""

    floating_base: bool = False
    euler: bool = False  # attitudes of free links by three angles, not by a quaternion
    mend: bool = False  # inertias that no body can have are raised
    within: Decimal | None = None  # angles so near to a multiple of pi/12 become exact
