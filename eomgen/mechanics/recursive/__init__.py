"""Recursion over the tree of places on the graph: inverse dynamics, mass matrix, articulated bodies."""
