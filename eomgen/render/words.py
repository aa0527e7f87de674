"""The words of the notes, language by language; every language has every word."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.errors import UsageError

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
        "speeds": "The speeds are",
        "rates": "so that the rates are",
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
        "speeds": "Las velocidades generalizadas son",
        "rates": "de modo que",
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
    return WORDS[language]


def title(titles: Mapping[str, str], language: str) -> str:
    """The title in that language, or the first that the spec gives."""
    return titles.get(language) or next(iter(titles.values()))
