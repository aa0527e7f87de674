"""Recursion over a tree of places: inverse dynamics, mass matrix, articulated bodies."""
