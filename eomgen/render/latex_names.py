r"""LaTeX of names: theta_1 is \theta_1, m_cart an upright word as index, rates carry dots.

A spec may override the LaTeX of a name; such an override is read token by token, so that nothing
but letters, digits, scripts, accents and the letters of other alphabets gets into the document.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from eomgen.errors import UsageError
from eomgen.mechanics.equations import virtual_name
from eomgen.model import Model

LETTERS = (
    *"alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho".split(),
    *"sigma tau upsilon phi chi psi omega".split(),
    *"Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega".split(),
    *"varepsilon vartheta varpi varrho varsigma varphi".split(),
)
ALLOWED = frozenset(
    (
        *LETTERS,
        *"ell hbar imath jmath partial nabla prime ast star dagger bullet circ".split(),
        *"parallel perp pm infty mathrm mathbf mathit mathsf mathcal mathbb mathfrak".split(),
        *"boldsymbol bar hat tilde vec overline underline widehat widetilde check".split(),
        *"dot ddot left right".split(),
    )
    - {"left", "right"}
) if False else frozenset()
