"""The words of the formalisms, language by language; every language has every word."""

from __future__ import annotations

from collections.abc import Mapping

WORDS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "newton": "Newton's and Euler's equations",
        "newton_said": "Each body by itself, with every force that acts on it, those between"
        " components too; what one body does to another acts back on it with the opposite sign.",
        "moments_said": "Moments are about the mass centre.",
        "moments_body": "Moments are about the mass centre, in the axes of the body.",
        "unknowns": "The forces between components are",
        "unknown_S": "{symbol}, {of_parent} on {body}, along the line that joins them, positive"
        " where it pulls",
        "unknown_N": "{symbol}, {of_parent} on {body}, normal to its motion",
        "unknown_F": "{symbol}, {of_parent} on {body}, along its motion",
        "unknown_M": "{symbol}, the moment {of_parent} on {body}",
        "unknown_X": "{symbol}, {of_parent} on {body}, component along x",
        "unknown_Y": "{symbol}, {of_parent} on {body}, component along y",
        "unknown_Z": "{symbol}, {of_parent} on {body}, component along z",
        "of_world": "of the ground",
        "of_body": "of {name}",
        "resultants": "The resultants of all forces of constraint on each body are unknown:"
        " {forces} for the force, {moments} for the moment about the mass centre.",
        "resultants_forces": "The resultants of all forces of constraint on each body are unknown:"
        " {forces}.",
        "no_unknowns": "Nothing holds the bodies but the forces that are shown.",
        "elimination": "Elimination of the reactions",
        "sums_joints": "Each equation, multiplied as shown, is added; no force between components"
        " is left:",
        "projection": "Equations of the coordinates",
        "sums_plain": "Each equation, multiplied as shown, is added:",
        "sums_resultants": "Each equation, multiplied as shown, is added; what is left of the"
        " forces of constraint is their virtual work:",
        "work_ideal": "Ideal forces of constraint do no virtual work:",
        "work_other": "Ideal forces of constraint do no virtual work; that of springs, dampers and"
        " multipliers along coordinates is left:",
        "reactions": "Forces between components",
        "reactions_said": "They follow from the motion:",
        "reactions_named": "Forces of constraint",
        "named_on": "{name}, the force on {on}:",
        "named_coordinates": "{name}, the generalized force along each coordinate:",
        "dalembert": "d'Alembert's principle",
        "dalembert_said": "The virtual work of the applied forces and of the inertial forces is"
        " zero for every virtual displacement; ideal forces of constraint do none.",
        "inertial": "Inertial forces and virtual displacements",
        "momentum_said": "The components of the rate of the angular momentum and of the virtual"
        " rotation are in the axes of the body.",
        "applied_works": "Virtual work of the applied forces",
        "no_works": "No applied force does virtual work.",
        "coefficients": "The coefficient of each virtual displacement vanishes:",
        "coefficients_linked": "The virtual displacements are linked; with a multiplier for each"
        " constraint the coefficient of each vanishes:",
        "kane": "Kane's equations",
        "kane_said": "For each speed the generalized active forces and the generalized inertia"
        " forces add up to zero.",
        "partials": "Partial velocities of the mass centres and partial angular velocities",
        "active": "Generalized active forces",
        "inertia_forces": "Generalized inertia forces",
        "kane_linked": "The speeds are linked; each constraint adds its multiplier.",
        "cartesian_said": "With the Cartesian coordinates of the mass centres beside the"
        " generalized ones, the set is linked: {count} coordinates, {links} constraints,"
        " {freedom} degrees of freedom.",
        "cartesian_links": "The constraints are",
        "cartesian_energy": "The kinetic energy of the rotation, and the part that is given, is",
        "cartesian_rows": "Lagrange's equations of the Cartesian coordinates are",
        "cartesian_rest": "and those of the generalized coordinates",
        "cartesian_end": "The multipliers from the first equations, put into the others with the"
        " second derivatives of the constraints, leave the equations of motion.",
    },
    "es": {
        "newton": "Ecuaciones de Newton y Euler",
        "newton_said": "Cada cuerpo por separado, con todas las fuerzas que actúan sobre él,"
        " incluidas las fuerzas entre componentes; lo que un cuerpo ejerce sobre otro actúa sobre"
        " él con signo contrario.",
        "moments_said": "Los momentos son respecto al centro de masas.",
        "moments_body": "Los momentos son respecto al centro de masas, en ejes del cuerpo.",
        "unknowns": "Las fuerzas entre componentes son",
        "unknown_S": "{symbol}, {of_parent} sobre {body}, según la recta que los une, positiva si"
        " tira",
        "unknown_N": "{symbol}, {of_parent} sobre {body}, normal a su movimiento",
        "unknown_F": "{symbol}, {of_parent} sobre {body}, según su movimiento",
        "unknown_M": "{symbol}, el momento {of_parent} sobre {body}",
        "unknown_X": "{symbol}, {of_parent} sobre {body}, componente según x",
        "unknown_Y": "{symbol}, {of_parent} sobre {body}, componente según y",
        "unknown_Z": "{symbol}, {of_parent} sobre {body}, componente según z",
        "of_world": "del suelo",
        "of_body": "de {name}",
        "resultants": "Son incógnitas las resultantes de todas las fuerzas de ligadura sobre cada"
        " cuerpo: {forces} para la fuerza, {moments} para el momento respecto al centro de masas.",
        "resultants_forces": "Son incógnitas las resultantes de todas las fuerzas de ligadura sobre"
        " cada cuerpo: {forces}.",
        "no_unknowns": "Sobre los cuerpos no actúan más fuerzas que las que figuran.",
        "elimination": "Eliminación de las reacciones",
        "sums_joints": "Se suma cada ecuación multiplicada como se indica; no queda ninguna fuerza"
        " entre componentes:",
        "projection": "Ecuaciones de las coordenadas",
        "sums_plain": "Se suma cada ecuación multiplicada como se indica:",
        "sums_resultants": "Se suma cada ecuación multiplicada como se indica; de las fuerzas de"
        " ligadura queda su trabajo virtual:",
        "work_ideal": "Las fuerzas de ligadura ideales no realizan trabajo virtual:",
        "work_other": "Las fuerzas de ligadura ideales no realizan trabajo virtual; queda el de"
        " muelles, amortiguadores y multiplicadores según las coordenadas:",
        "reactions": "Fuerzas entre componentes",
        "reactions_said": "Se deducen del movimiento:",
        "reactions_named": "Fuerzas de ligadura",
        "named_on": "{name}, la fuerza sobre {on}:",
        "named_coordinates": "{name}, la fuerza generalizada según cada coordenada:",
        "dalembert": "Principio de d'Alembert",
        "dalembert_said": "El trabajo virtual de las fuerzas aplicadas y de las fuerzas de inercia"
        " es nulo en todo desplazamiento virtual; las fuerzas de ligadura ideales no lo realizan.",
        "inertial": "Fuerzas de inercia y desplazamientos virtuales",
        "momentum_said": "Las componentes de la derivada del momento cinético y del giro virtual"
        " son en ejes del cuerpo.",
        "applied_works": "Trabajo virtual de las fuerzas aplicadas",
        "no_works": "Ninguna fuerza aplicada realiza trabajo virtual.",
        "coefficients": "El coeficiente de cada desplazamiento virtual es nulo:",
        "coefficients_linked": "Los desplazamientos virtuales están ligados; con un multiplicador"
        " por ligadura, el coeficiente de cada uno es nulo:",
        "kane": "Ecuaciones de Kane",
        "kane_said": "Para cada velocidad generalizada, las fuerzas activas generalizadas y las"
        " fuerzas de inercia generalizadas suman cero.",
        "partials": "Velocidades parciales de los centros de masas y velocidades angulares"
        " parciales",
        "active": "Fuerzas activas generalizadas",
        "inertia_forces": "Fuerzas de inercia generalizadas",
        "kane_linked": "Las velocidades están ligadas; cada ligadura suma su multiplicador.",
        "cartesian_said": "Con las coordenadas cartesianas de los centros de masas junto a las"
        " generalizadas, el conjunto es ligado: {count} coordenadas, {links} ligaduras, {freedom}"
        " grados de libertad.",
        "cartesian_links": "Las ligaduras son",
        "cartesian_energy": "La energía cinética de rotación, y la parte dada, es",
        "cartesian_rows": "Las ecuaciones de Lagrange de las coordenadas cartesianas son",
        "cartesian_rest": "y las de las coordenadas generalizadas",
        "cartesian_end": "Los multiplicadores de las primeras ecuaciones, llevados a las demás con"
        " las segundas derivadas de las ligaduras, dejan las ecuaciones del movimiento.",
    },
}
