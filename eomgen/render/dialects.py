"""What C and Python call the operators, how they write numbers, which names they reserve."""

import keyword
from collections.abc import Mapping
from dataclasses import dataclass
from sys import maxsize

from eomgen.program import OPERATORS


@dataclass(frozen=True)
class Dialect:
    """How a language writes numbers and calls, and the names that it keeps for itself."""

    number: str  # format of a literal
    calls: Mapping[str, str]  # operator -> name
    reserved: frozenset[str]  # names that a local variable cannot have
    reserved_members: frozenset[str]  # names that a parameter cannot have
    pairs: bool = False  # sine and cosine of an angle in one statement
    lanes: bool = False  # functions also for many states at once
    loops: bool = False  # limbs that are alike in a loop
    longest: int = maxsize  # statements of a function that is not cut into parts
    once: int = maxsize  # the same of `prepare`, whose own time matters less
    repeated: int = maxsize  # statements that are written again rather than called


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_KEYWORDS = _words("""
auto break case char const continue default do double else enum extern float for goto if inline int
long register restrict return short signed sizeof static struct switch typedef union unsigned void
volatile while alignas alignof and and_eq asm atomic_cancel atomic_commit atomic_noexcept bitand
bitor bool catch char16_t char32_t char8_t class co_await co_return co_yield compl concept
const_cast consteval constexpr constinit decltype delete dynamic_cast explicit export false friend
mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public
reinterpret_cast requires static_assert static_cast template this thread_local throw true try
typeid typename typeof typeof_unqual using virtual wchar_t xor xor_eq near far huge pascal cdecl
""")
_MACROS = _words("""
I NULL EOF NAN INFINITY HUGE HUGE_VAL DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS
complex imaginary errno assert linux unix i386 stdin stdout stderr offsetof
HUGE_VALF HUGE_VALL MAXFLOAT SNAN FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL DECIMAL_DIG
M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2
SIZE_MAX PTRDIFF_MAX PTRDIFF_MIN INTMAX_MAX INTMAX_MIN UINTMAX_MAX INTPTR_MAX INTPTR_MIN UINTPTR_MAX
""")
_RANGES = _words("MAX MIN EPSILON DIG MANT_DIG MAX_EXP MIN_EXP MAX_10_EXP MIN_10_EXP RADIX ROUNDS")
_LIMITS = {f"{kind}_{which}" for kind in ("FLT", "DBL", "LDBL") for which in _RANGES} | {
    f"{kind}{size}_{end}" for kind in ("INT", "UINT") for size in (8, 16, 32, 64)
    for end in ("MAX", "MIN")
}  # fmt: skip
# those of our templates that are no calls: they would replace a member too
_OWN_MACROS = _words("EPSILON LANES ALIGNED SIDE_BY_SIDE APART INLINED WAVE_RANGE SIGN_BIT PIECE")
_MATH = _words("""
acos asin atan atan2 cos sin tan cosh sinh tanh acosh asinh atanh exp exp2 exp10 expm1 frexp ilogb
ldexp log log10 log1p log2 logb modf scalb scalbn scalbln cbrt fabs hypot pow pow10 sqrt erf erfc
gamma lgamma tgamma ceil floor nearbyint rint lrint llrint round lround llround trunc fmod drem
remainder remquo copysign nan nextafter nexttoward fdim fmax fmin fma j0 j1 jn y0 y1 yn signgam
significand finite isnan isinf isfinite isnormal signbit fpclassify abs div index
""")
_C_MEMBERS = _KEYWORDS | _MACROS | _LIMITS | _OWN_MACROS

C_FUNCTIONS = {  # operator -> function of <math.h>; its macro is the name in capitals
    "sin": "sin", "cos": "cos", "tan": "tan", "asin": "asin", "acos": "acos", "atan": "atan",
    "atan2": "atan2", "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "sqrt": "sqrt", "exp": "exp",
    "log": "log", "abs": "fabs", "min": "fmin", "max": "fmax", "power": "pow",
}  # fmt: skip
_C_CALLS = {operator: name.upper() for operator, name in C_FUNCTIONS.items()} | {"sign": "SIGN"}
# statements of about four operations each: beyond, gcc -O2 takes more than linear time
LONGEST = 1000
ONCE = 300
REPEATED = 200  # a call takes a hundredth of the time of so many
_OWN = _words("""
t state accelerations inputs p m work result waves lane bad REAL PIVOT NOT_ABOVE
bits bits_of real_of reduced sine_and_cosine sine cosine
lane_waves lane_sine lane_cosine gather scatter gather_last scatter_last pick
""")
C = Dialect(
    number="REAL({})",
    calls=_C_CALLS,
    reserved=_C_MEMBERS
    | _OWN
    | {name + suffix for name in _MATH for suffix in ("", "f", "l")}
    | frozenset(_C_CALLS.values()),
    reserved_members=_C_MEMBERS,
    pairs=True,
    loops=True,
    longest=LONGEST,
    once=ONCE,
    repeated=REPEATED,
)
PYTHON = Dialect(
    number="{}",
    calls={
        **{o: f"np.{o}" for o in ("sin", "cos", "tan", "sinh", "cosh", "tanh")},
        **{o: f"np.{o}" for o in ("sqrt", "exp", "log", "abs", "sign", "power")},
        **{o: f"np.arc{o[1:]}" for o in ("asin", "acos", "atan", "atan2")},
        "min": "np.fmin", "max": "np.fmax",
    },
    reserved=frozenset(keyword.kwlist)
    | {"np", "t", "state", "accelerations", "inputs", "parameters", "model", "Model", "float"}
    | {"l", "O", "I"},  # hard to tell from 1 and 0: linters reject them (E741)
    reserved_members=frozenset(),  # keys of a dictionary
)  # fmt: skip
PLAIN = Dialect(  # for comments
    number="{}",
    calls={name: name for name in OPERATORS},
    reserved=frozenset(),
    reserved_members=frozenset(),
)
