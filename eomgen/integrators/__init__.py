"""Integrators with a step as data: tableaus, and the table of methods that generated C can have."""
