r"""A spec's own LaTeX of a name, read token by token: \varphi, \bar{x}_1, c', k_{\mathrm{in}}.

    name = atom+        atom = nucleus '* (_ script)? (^ script)?
    nucleus = letter | digit | \alpha ... | \bar{name} ... | {name}
    script = letter | digit | \alpha ... | {name}

Nothing else gets into the document: no other macro, and never half a construction.
"""

from __future__ import annotations

import re

from eomgen.errors import UsageError

GREEK = frozenset(
    (
        *("alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa"),
        *("lambda", "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi"),
        *("omega", "Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Upsilon", "Phi"),
        *("Psi", "Omega", "varepsilon", "vartheta", "varpi", "varrho", "varsigma", "varphi"),
    )
)
SIGNS = frozenset(
    ("ell", "hbar", "imath", "jmath", "prime", "ast", "star", "dagger", "circ", "parallel", "perp")
)
ACCENTS = frozenset(
    (
        *("mathrm", "mathbf", "mathit", "mathsf", "mathcal", "mathbb", "mathfrak", "boldsymbol"),
        *("bar", "hat", "tilde", "vec", "check", "breve", "overline", "underline", "widehat"),
        *("widetilde",),
    )
)
TOKEN = re.compile(r"\s*(\\[A-Za-z]+|[A-Za-z0-9{}_^',*+-])")
PLAIN = re.compile(r"[A-Za-z0-9,*+-]")
DEEPEST = 8


HINT = (
    r"letters, digits, _ ^ ' { }, Greek letters and accents make a name, such as \varphi, "
    r"\bar{x}_1, k_{\mathrm{in}}"
)


def is_name(text: str) -> bool:
    """Whether a text without white space around it is a name and no more."""
    tokens = TOKEN.findall(text)
    spaces = re.sub(r"\s", "", text)
    return "".join(tokens) == spaces and bool(tokens) and _name(tokens, 0, 0) == len(tokens)


def checked(name: str, override: str) -> str:
    """The override without white space around it, if it is a name and no more.

    Raises:
        UsageError: it holds anything that a name does not need; a spec was refused for it before.
    """
    text = override.strip()
    if is_name(text):
        return text
    raise UsageError(f"the LaTeX of {name}, {override!r}, is not a name: {HINT}")


def _name(tokens: list[str], at: int, depth: int) -> int:
    """Where the name that starts there ends; 0 if there is none."""
    end = at if depth < DEEPEST else len(tokens)
    while end < len(tokens) and tokens[end] != "}":
        end = _atom(tokens, end, depth)
        if not end:
            return 0
    return end if end > at else 0


def _atom(tokens: list[str], at: int, depth: int) -> int:
    """The end of a nucleus with its primes and scripts."""
    accent = tokens[at].startswith("\\") and tokens[at][1:] in ACCENTS
    end = _group(tokens, at + 1, depth) if accent else _unit(tokens, at, depth)
    while end and tokens[end : end + 1] == ["'"]:
        end += 1
    primed = bool(end) and tokens[end - 1] == "'"
    for script in ("_",) if primed else ("_", "^"):
        if end and tokens[end : end + 1] == [script]:
            end = _unit(tokens, end + 1, depth)
    return end


def _unit(tokens: list[str], at: int, depth: int) -> int:
    """The end of one letter, digit, Greek letter, sign or group."""
    if at >= len(tokens):
        return 0
    token = tokens[at]
    if token == "{":
        return _group(tokens, at, depth)
    single = PLAIN.fullmatch(token) or token.startswith("\\") and token[1:] in GREEK | SIGNS
    return at + 1 if single else 0


def _group(tokens: list[str], at: int, depth: int) -> int:
    """The end of {name}."""
    if tokens[at : at + 1] != ["{"]:
        return 0
    end = _name(tokens, at + 1, depth + 1)
    return end + 1 if end and tokens[end : end + 1] == ["}"] else 0
