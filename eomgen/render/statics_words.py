"""The words of statics, language by language, and the solver's sentences in other languages."""

from __future__ import annotations

import re
from collections.abc import Mapping

ORIGINS = ("weights", "springs", "potential_given", "dampers", "applied")

WORDS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "statics": "Statics",
        "work": "Virtual work",
        "principle": "In equilibrium the virtual work of all applied forces vanishes, whatever the"
        " virtual displacement:",
        "principle_linked": "In equilibrium the virtual work of all applied forces vanishes for"
        " every virtual displacement that the constraints admit; the forces of ideal constraints do"
        " none:",
        "forces_said": "Generalized forces",
        "weights": "weights",
        "springs": "springs",
        "potential_given": "given potential",
        "dampers": "dampers",
        "applied": "applied",
        "equilibrium": "Equilibrium equations",
        "multipliers_said": "Each constraint brings a multiplier, times the coefficient of the"
        " virtual displacement in its virtual form:",
        "together": "together with the constraints",
        "gaps": "A unilateral constraint that touches counts as a bilateral one whose multiplier is"
        " not negative; one that does not touch exerts no force:",
        "equilibria": "Equilibria",
        "at": "Given",
        "found": "{count} equilibria were found.",
        "found_one": "One equilibrium was found.",
        "found_none": "No equilibrium was found.",
        "number": "no.",
        "stability": "stability",
        "touching": "touching",
        "any": "any",
        "any_value": "Nothing depends on {symbols}: any value is one of equilibrium.",
        "stable": "stable",
        "unstable": "unstable",
        "undecided": "undecided",
        "not_isolated": "not isolated",
        "multipliers_si": "Multipliers are in SI units.",
        "reactions": "{force} is the force of a constraint on its body, or on the first of the two"
        " points that coincide, in the axes of the world.",
        "not_unique": "The multipliers are not determined, one choice is shown, at: {numbers}.",
        "method": "Method",
        "complete": "The list is complete for the range that was searched.",
        "incomplete": "The list may be incomplete.",
        "notes": "Notes",
    },
    "es": {
        "statics": "Estática",
        "work": "Trabajo virtual",
        "principle": "En equilibrio se anula el trabajo virtual de todas las fuerzas aplicadas, sea"
        " cual sea el desplazamiento virtual:",
        "principle_linked": "En equilibrio se anula el trabajo virtual de todas las fuerzas"
        " aplicadas para todo desplazamiento virtual compatible con las ligaduras; las fuerzas de"
        " ligadura ideales no realizan ninguno:",
        "forces_said": "Fuerzas generalizadas",
        "weights": "pesos",
        "springs": "muelles",
        "potential_given": "potencial dado",
        "dampers": "amortiguadores",
        "applied": "aplicadas",
        "equilibrium": "Ecuaciones de equilibrio",
        "multipliers_said": "Cada ligadura aporta un multiplicador, por el coeficiente del"
        " desplazamiento virtual en su forma virtual:",
        "together": "junto con las ligaduras",
        "gaps": "Una ligadura unilateral en contacto cuenta como una bilateral cuyo multiplicador"
        " no es negativo; sin contacto no ejerce fuerza:",
        "equilibria": "Posiciones de equilibrio",
        "at": "Datos",
        "found": "Se han hallado {count} posiciones de equilibrio.",
        "found_one": "Se ha hallado una posición de equilibrio.",
        "found_none": "No se ha hallado ninguna posición de equilibrio.",
        "number": "n.º",
        "stability": "estabilidad",
        "touching": "en contacto",
        "any": "cualquiera",
        "any_value": "Nada depende de {symbols}: cualquier valor es de equilibrio.",
        "stable": "estable",
        "unstable": "inestable",
        "undecided": "sin decidir",
        "not_isolated": "no aislada",
        "multipliers_si": "Los multiplicadores están en unidades SI.",
        "reactions": "{force} es la fuerza de una ligadura sobre su cuerpo, o sobre el primero de"
        " los dos puntos que coinciden, en los ejes fijos.",
        "not_unique": "Los multiplicadores no están determinados, se muestra una elección, en:"
        " {numbers}.",
        "method": "Método",
        "complete": "La lista es completa en la región explorada.",
        "incomplete": "La lista puede ser incompleta.",
        "notes": "Notas",
    },
}


def of(language: str) -> Mapping[str, str]:
    """The words of a language that the notes have."""
    return WORDS[language]


# what the solver says, and what that is in Spanish; `rest`, `end`, `where` are translated in turn
SPANISH: tuple[tuple[str, str], ...] = (
    (
        r"(?P<rest>.+), but for (?P<count>\d+) that the unilateral constraints refuse",
        "{rest}, salvo {count} que las ligaduras unilaterales no admiten",
    ),
    (r"(?P<rest>.+?); (?P<end>.+)", "{rest}; {end}"),
    (r"touching (?P<names>[^:]+): (?P<rest>.+)", "en contacto {names}: {rest}"),
    # how it was searched
    (r"exact elimination: (?P<rest>.+)", "eliminación exacta: {rest}"),
    (
        r"(?P<rest>.+), (?P<count>\d+) of these outside the range",
        "{rest}, {count} de ellas fuera de la región",
    ),
    (
        r"(?P<rest>.+), (?P<count>\d+) were found outside the range",
        "{rest}, {count} se hallaron fuera de la región",
    ),
    (
        r"the equations contradict each other, so there is no equilibrium",
        "las ecuaciones se contradicen, así que no hay equilibrio",
    ),
    (
        r"of (?P<count>\d+) complex solutions (?P<real>\d+) are equilibria",
        "{real} de las {count} soluciones complejas son de equilibrio",
    ),
    (
        r"irrational constants were rounded to (?P<count>\d+) digits",
        "las constantes irracionales se han redondeado a {count} dígitos",
    ),
    (r"every position is an equilibrium", "toda posición es de equilibrio"),
    (
        r"interval arithmetic: every root(?P<where> within .+?\))? is among these(?P<end>.*)",
        "aritmética de intervalos: toda raíz{where} está entre estas{end}",
    ),
    (
        r" within (?P<size>\S+) \((?P<count>\S+) times the size of the scene\)",
        " hasta {size} ({count} veces el tamaño de la escena)",
    ),
    (
        r", but roots closer than (?P<size>\S+) of the range are not told apart near (?P<names>.+)",
        ", pero no se distinguen raíces más próximas que {size} de la región cerca de {names}",
    ),
    (r"no polynomials: (?P<rest>.+)", "no son polinomios: {rest}"),
    (
        r"(?P<name>.+) stands inside and outside of sine and cosine",
        "{name} figura dentro y fuera de senos y cosenos",
    ),
    (r"the function (?P<name>.+) is no polynomial", "la función {name} no es un polinomio"),
    (
        r"the equations have infinitely many complex solutions",
        "las ecuaciones tienen infinitas soluciones complejas",
    ),
    (
        r"too many complex solutions for exact elimination",
        "demasiadas soluciones complejas para la eliminación exacta",
    ),
    (
        r"rounding irrational constants proves no absence of roots",
        "redondear constantes irracionales no demuestra que falten raíces",
    ),
    (
        r"searched by Newton's method from (?P<count>\d+) starts(?P<where> within .+)?",
        "búsqueda por el método de Newton desde {count} puntos{where}",
    ),
    (r"no root was found", "no se ha hallado ninguna raíz"),
    (
        r"each root was found at least (?P<times>once|\d+ times), the (?P<count>\d+) starts after"
        r" start (?P<last>\d+) found no new one, (?P<failed>\d+) led to none",
        "cada raíz se ha hallado al menos {times}, los {count} puntos que siguen al {last} no han"
        " dado ninguna nueva, {failed} no han llevado a ninguna",
    ),
    (r"roots may have been missed", "puede haber raíces sin hallar"),
    # why an equilibrium is called stable or not
    (r"undecided by energy: (?P<rest>.+)", "la energía no lo decide: {rest}"),
    (
        r"no admissible virtual displacement: nothing can move",
        "no hay desplazamiento virtual admisible: nada puede moverse",
    ),
    (
        r"constraints between rates are no constraints on positions",
        "las ligaduras entre velocidades no ligan las posiciones",
    ),
    (r"the constraints lose rank here", "las ligaduras pierden rango aquí"),
    (
        r"the applied forces have no potential",
        "las fuerzas aplicadas no derivan de un potencial",
    ),
    (r"linearize instead", "conviene linealizar"),
    (r"(?P<names>.+) touches without a force", "{names} toca sin fuerza"),
    (
        r"V falls along an admissible virtual displacement",
        "V disminuye en un desplazamiento virtual admisible",
    ),
    (
        r"V has a minimum among the admissible positions",
        "V tiene un mínimo entre las posiciones admisibles",
    ),
    (
        r"the second variation vanishes along an admissible virtual displacement",
        "la segunda variación se anula en un desplazamiento virtual admisible",
    ),
    # what is left out
    (
        r"motion is prescribed: it stands still at the given time, and its inertia loads are no"
        r" applied forces",
        "hay movimiento prescrito: está detenido en el instante dado, y sus fuerzas de inercia no"
        " son fuerzas aplicadas",
    ),
    (
        r"a steady motion \(relative equilibrium\) is not an equilibrium of applied forces",
        "un movimiento estacionario (equilibrio relativo) no es un equilibrio de fuerzas aplicadas",
    ),
    (
        r"forces or constraints depend on time: they stand still at the given time",
        "hay fuerzas o ligaduras que dependen del tiempo: están detenidas en el instante dado",
    ),
    (
        r"friction is left out: with it, equilibria spread over a region",
        "se omite el rozamiento: con él, los equilibrios llenan una región",
    ),
    (
        r"inputs not given are zero: (?P<names>.+)",
        "las entradas que no se dan son nulas: {names}",
    ),
    (
        r"unilateral constraints were tried one at a time, not together",
        "las ligaduras unilaterales se han probado de una en una, no juntas",
    ),
    (
        r"the equilibria form a continuous family, (?P<count>\d+) members are shown",
        "los equilibrios forman una familia continua, de la que se muestran {count}",
    ),
    (r"once", "una vez"),
    (r"(?P<count>\d+) times", "{count} veces"),
)
SENTENCES: Mapping[str, tuple[tuple[str, str], ...]] = {"en": (), "es": SPANISH}
NESTED = frozenset(("rest", "end", "where", "times"))


def translated(sentence: str, language: str) -> str:
    """A sentence of the solver in a language; as it is where there is no row for it."""
    for pattern, shown in SENTENCES[language]:
        found = re.fullmatch(pattern, sentence)
        if found:
            parts = found.groupdict(default="")
            return shown.format(
                **{k: translated(v, language) if k in NESTED else v for k, v in parts.items()}
            )
    return sentence
