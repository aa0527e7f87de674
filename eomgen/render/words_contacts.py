"""The words of contacts, language by language; every language has every word."""

from __future__ import annotations

from collections.abc import Mapping

WORDS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "contacts": "Contacts",
        "contact_gap": "The gap and its rate are",
        "contact_flight": "Flight: the gap is positive, {force}, and the equations of motion are"
        " those above.",
        "contact_closed": "Contact: the gap and its rates vanish, {force} is not negative, and the"
        " equations of motion are",
        "contact_second": "together with the second rate of the gap",
        "contact_force": "In contact, the multiplier, and from it the force of the contact, is",
        "contact_normal": "The force of the contact is",
        "contact_ends": "Contact ends where {force} falls to zero.",
        "contact_impact": "Impact, with the impulse {impulse}: the positions stay, and the rates"
        " change by",
        "contact_restitution": "so that the rate of the gap is reversed and multiplied by {value}:",
        "contact_friction": "Friction acts on {point}, along the tangent, against the slip"
        " velocity {slip}. With its force {force} the equations of motion are",
        "contact_friction_solid": "Friction acts on {point}, in the tangent plane, against the slip"
        " velocity {slip}; its force is {force}.",
        "contact_stick": "Stick: no slip, and the force stays below its limit,",
        "contact_slip": "Slip: the force has its limit,",
    },
    "es": {
        "contacts": "Contactos",
        "contact_gap": "La holgura y su derivada son",
        "contact_flight": "Vuelo: la holgura es positiva, {force}, y las ecuaciones del movimiento"
        " son las de arriba.",
        "contact_closed": "Contacto: la holgura y sus derivadas son nulas, {force} no es negativo,"
        " y las ecuaciones del movimiento son",
        "contact_second": "junto con la segunda derivada de la holgura",
        "contact_force": "En contacto, el multiplicador, y de él la fuerza de contacto, es",
        "contact_normal": "La fuerza de contacto es",
        "contact_ends": "El contacto termina donde {force} se anula.",
        "contact_impact": "Choque, con la percusión {impulse}: las posiciones se conservan y las"
        " velocidades cambian en",
        "contact_restitution": "de modo que la derivada de la holgura se invierte y se multiplica"
        " por {value}:",
        "contact_friction": "El rozamiento actúa sobre {point}, según la tangente, contra la"
        " velocidad de deslizamiento {slip}. Con su fuerza {force} las ecuaciones del movimiento"
        " son",
        "contact_friction_solid": "El rozamiento actúa sobre {point}, en el plano tangente, contra"
        " la velocidad de deslizamiento {slip}; su fuerza es {force}.",
        "contact_stick": "Adherencia: no desliza, y la fuerza no alcanza su límite,",
        "contact_slip": "Deslizamiento: la fuerza alcanza su límite,",
    },
}
