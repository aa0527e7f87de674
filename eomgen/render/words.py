"""The words of the notes, language by language; every language has every word."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.errors import UsageError
from eomgen.render import words_contacts, words_principles

WORDS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "data": "Data",
        "symbol": "symbol",
        "meaning": "meaning",
        "value": "value",
        "unit": "unit",
        "parameters": "The parameters are",
        "coordinates": "Generalized coordinates",
        "coordinates_free": "The coordinates are free: their number, {count}, is that of the"
        " degrees of freedom.",
        "constraints": "Constraints",
        "bilateral": "bilateral",
        "unilateral": "unilateral",
        "scleronomic": "scleronomic",
        "rheonomic": "rheonomic",
        "holonomic": "holonomic",
        "nonholonomic": "nonholonomic: it cannot be integrated ({growth})",
        "integrable": "holonomic: stated between rates, it can be integrated",
        "inequality": "not holonomic, for an inequality eliminates no coordinate",
        "virtual": "A virtual displacement, infinitesimal and at constant time, keeps every"
        " constraint:",
        "virtual_rates": "Where a constraint is stated between rates, the coefficients of the rates"
        " take the place of these derivatives.",
        "form_equation": "constraint",
        "form_gap": "gap",
        "form_rate": "rate form",
        "form_virtual": "virtual form",
        "form_rate_contact": "rate form, in contact",
        "form_virtual_contact": "virtual form, in contact",
        "form_hidden": "integrated",
        "constant": "constant",
        "multiplier": "Multiplier: {symbols}.",
        "multipliers": "Multipliers: {symbols}.",
        "redundant": "Redundant, as it follows from other constraints: {rows}.",
        "hidden_unknown": "What it says between positions was not found in closed form.",
        "contact": "In contact the gap is zero, the constraint holds as a bilateral one does, and"
        " its force acts only so as to open the gap: its multiplier is not negative. In flight the"
        " gap is positive and there is no force.",
        "restitution": "An impact reverses the rate of the gap and multiplies it by {value}.",
        "friction": "Coulomb friction, with the coefficient {value}, resists sliding.",
        "growth": "The numbers are the dimensions that the admissible directions span: alone, then"
        " with their brackets, step by step.",
        "growth_time": "The time counts as a coordinate there.",
        "freedom": "Degrees of freedom",
        "count_coordinates": "number of coordinates",
        "count_rank": "rank of the constraints",
        "count_freedom": "degrees of freedom (independent virtual displacements)",
        "count_minimal": "minimal number of coordinates",
        "proof": "The rank was found at {states} admissible states.",
        "all_holonomic": "Every bilateral constraint is holonomic: the minimal number of"
        " coordinates is that of the degrees of freedom, {minimal}.",
        "some_nonholonomic": "A constraint that cannot be integrated restricts the virtual"
        " displacements, not the configurations: the minimal number of coordinates, {minimal}, is"
        " greater than that of the degrees of freedom, {freedom}.",
        "count_contact": "This holds in flight; a closed gap counts as one more constraint.",
        "combined": "Together they can be integrated:",
        "basis": "Basis of the virtual displacements: {symbols}.",
        "basis_others": "Basis of the virtual displacements: {symbols}. The others follow from it:",
        "no_basis": "No virtual displacement is possible.",
        "coordinates_linked": "The set of coordinates is linked: their number, {count}, is greater"
        " than that of the degrees of freedom, {freedom}.",
        "coordinates_turns": "The {count} coordinates hold quaternions, each of length one, whose"
        " parts are not independent: there are {freedom} degrees of freedom.",
        "coordinates_independent": "The coordinates are independent of each other, and yet their"
        " number, {count}, is greater than that of the degrees of freedom, {freedom}.",
        "first_kind": "Lagrange's equations of the first kind",
        "ideal": "Ideal constraint forces do no virtual work. Each constraint brings a"
        " multiplier; what stands beside it, {math}, is the coefficient of the virtual displacement"
        " in the virtual form.",
        "together": "together with the constraints",
        "flight": "These are the equations of flight. In contact, each closed gap adds its"
        " multiplier, times the coefficient of the virtual displacement in its virtual form, to the"
        " generalized force.",
        "rough": "These are the equations without friction. In each mode it adds its generalized"
        " force: while a constraint sticks, what keeps the touching point at rest, smaller than the"
        " coefficient times the normal force; while it slides, the coefficient times the normal"
        " force, against the slip.",
        "speeds": "The speeds are",
        "rates": "so that the rates are",
        "turns": "There is no coordinate {math}: it stands for a virtual turn about an axis of the"
        " turned frame, along which the parts of the quaternion change as they do with the rates.",
        "prescribed": "Prescribed motions",
        "inputs": "Inputs",
        "kinematics": "Positions and velocities",
        "spins": "The angular velocities are",
        "spins_body": "The angular velocities, in the axes of the bodies, are",
        "kinetic": "Kinetic energy",
        "potential": "Potential energy",
        "no_potential": "No force has a potential: {math}.",
        "lagrangian": "Lagrangian",
        "dissipation": "Dissipation function",
        "forces": "Virtual work and generalized forces",
        "no_forces": "No other force does virtual work: {math} for every coordinate.",
        "steps": "Lagrange's equations",
        "steps_for": "Coordinate",
        "steps_turn": "Virtual turn",
        "equation": "The equation of motion is",
        "divided": "Divided by {divisor}, the equation of motion is",
        "equations": "Equations of motion",
        "for_speeds": "Projected on the speeds, the equations are",
        "matrix": "Matrix form",
        "symmetric": "The mass matrix is symmetric; entries that are not listed are zero.",
        "long": "a sum of {count} terms",
        "given": "given",
        "translation": "translation",
        "rotation": "rotation",
    },
    "es": {
        "data": "Datos",
        "symbol": "símbolo",
        "meaning": "significado",
        "value": "valor",
        "unit": "unidad",
        "parameters": "Los parámetros son",
        "coordinates": "Coordenadas generalizadas",
        "coordinates_free": "El conjunto de coordenadas es libre: su número, {count}, es el de"
        " grados de libertad.",
        "constraints": "Ligaduras",
        "bilateral": "bilateral",
        "unilateral": "unilateral",
        "scleronomic": "esclerónoma",
        "rheonomic": "reónoma",
        "holonomic": "holónoma",
        "nonholonomic": "no holónoma: no se puede integrar ({growth})",
        "integrable": "holónoma: escrita entre velocidades, se puede integrar",
        "inequality": "no holónoma, pues una desigualdad no elimina ninguna coordenada",
        "virtual": "Un desplazamiento virtual, infinitesimal y a tiempo constante, cumple todas las"
        " ligaduras:",
        "virtual_rates": "Donde una ligadura se escribe entre velocidades, los coeficientes de las"
        " velocidades ocupan el lugar de estas derivadas.",
        "form_equation": "ligadura",
        "form_gap": "holgura",
        "form_rate": "en velocidades",
        "form_virtual": "forma virtual",
        "form_rate_contact": "en velocidades, en contacto",
        "form_virtual_contact": "forma virtual, en contacto",
        "form_hidden": "integrada",
        "constant": "constante",
        "multiplier": "Multiplicador: {symbols}.",
        "multipliers": "Multiplicadores: {symbols}.",
        "redundant": "Redundante, pues se deduce de otras ligaduras: {rows}.",
        "hidden_unknown": "No se ha hallado en forma cerrada su relación entre posiciones.",
        "contact": "En contacto la holgura es nula, la ligadura actúa como una bilateral y su"
        " fuerza solo tiende a abrir la holgura: su multiplicador no es negativo. En vuelo la"
        " holgura es positiva y no hay fuerza.",
        "restitution": "Un choque invierte la velocidad de la holgura y la multiplica por {value}.",
        "friction": "El rozamiento de Coulomb, de coeficiente {value}, se opone al deslizamiento.",
        "growth": "Los números son las dimensiones que generan las direcciones admisibles: solas, y"
        " después con sus corchetes, paso a paso.",
        "growth_time": "El tiempo cuenta ahí como una coordenada.",
        "freedom": "Grados de libertad",
        "count_coordinates": "número de coordenadas",
        "count_rank": "rango de las ligaduras",
        "count_freedom": "grados de libertad (desplazamientos virtuales independientes)",
        "count_minimal": "número mínimo de coordenadas",
        "proof": "El rango se ha hallado en {states} estados admisibles.",
        "all_holonomic": "Todas las ligaduras bilaterales son holónomas: el número mínimo de"
        " coordenadas es el de grados de libertad, {minimal}.",
        "some_nonholonomic": "Una ligadura que no se puede integrar restringe los desplazamientos"
        " virtuales, no las configuraciones: el número mínimo de coordenadas, {minimal}, es mayor"
        " que el de grados de libertad, {freedom}.",
        "count_contact": "Esto vale en vuelo; una holgura cerrada cuenta como una ligadura más.",
        "combined": "Juntas se pueden integrar:",
        "basis": "Base de los desplazamientos virtuales: {symbols}.",
        "basis_others": "Base de los desplazamientos virtuales: {symbols}. De ella se deducen los"
        " demás:",
        "no_basis": "Ningún desplazamiento virtual es posible.",
        "coordinates_linked": "El conjunto de coordenadas es ligado: su número, {count}, es mayor"
        " que el de grados de libertad, {freedom}.",
        "coordinates_turns": "Las {count} coordenadas contienen cuaterniones de longitud uno, cuyas"
        " partes no son independientes: hay {freedom} grados de libertad.",
        "coordinates_independent": "Las coordenadas son independientes entre sí y, aun así, su"
        " número, {count}, es mayor que el de grados de libertad, {freedom}.",
        "first_kind": "Ecuaciones de Lagrange de primera especie",
        "ideal": "Las fuerzas de ligadura ideales no realizan trabajo virtual. Cada ligadura"
        " aporta un multiplicador; lo acompaña {math}, el coeficiente del desplazamiento virtual en"
        " la forma virtual.",
        "together": "junto con las ligaduras",
        "flight": "Estas son las ecuaciones en vuelo. En contacto, cada holgura cerrada suma a la"
        " fuerza generalizada su multiplicador por el coeficiente del desplazamiento virtual en su"
        " forma virtual.",
        "rough": "Estas son las ecuaciones sin rozamiento. En cada modo este suma su fuerza"
        " generalizada: mientras una ligadura se adhiere, la que mantiene en reposo el punto de"
        " contacto, menor que el coeficiente por la fuerza normal; mientras desliza, el coeficiente"
        " por la fuerza normal, contra el deslizamiento.",
        "speeds": "Las velocidades generalizadas son",
        "rates": "de modo que",
        "turns": "No hay una coordenada {math}: designa un giro virtual alrededor de un eje del"
        " sistema girado; las partes del cuaternión varían con él como con las velocidades.",
        "prescribed": "Movimientos prescritos",
        "inputs": "Entradas",
        "kinematics": "Posiciones y velocidades",
        "spins": "Las velocidades angulares son",
        "spins_body": "Las velocidades angulares, en ejes de cada cuerpo, son",
        "kinetic": "Energía cinética",
        "potential": "Energía potencial",
        "no_potential": "Ninguna fuerza deriva de un potencial: {math}.",
        "lagrangian": "Lagrangiana",
        "dissipation": "Función de disipación",
        "forces": "Trabajo virtual y fuerzas generalizadas",
        "no_forces": "Ninguna otra fuerza realiza trabajo virtual: {math} para cada coordenada.",
        "steps": "Ecuaciones de Lagrange",
        "steps_for": "Coordenada",
        "steps_turn": "Giro virtual",
        "equation": "La ecuación del movimiento es",
        "divided": "Dividida por {divisor}, la ecuación del movimiento es",
        "equations": "Ecuaciones del movimiento",
        "for_speeds": "Proyectadas sobre las velocidades generalizadas, las ecuaciones son",
        "matrix": "Forma matricial",
        "symmetric": "La matriz de masas es simétrica; los elementos que no figuran son nulos.",
        "long": "una suma de {count} términos",
        "given": "dada",
        "translation": "traslación",
        "rotation": "rotación",
    },
}


def of(language: str) -> Mapping[str, str]:
    """The words of a language. Raises UsageError where there is none."""
    if language not in WORDS:
        raise UsageError(f"no notes in {language!r}: choose {' or '.join(WORDS)}")
    return {**WORDS[language], **words_principles.WORDS[language], **words_contacts.WORDS[language]}


def title(titles: Mapping[str, str], language: str) -> str:
    """The title in that language, or the first that the spec gives."""
    return titles.get(language) or next(iter(titles.values()))
