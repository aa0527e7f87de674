"""Equations of motion from one text file."""

from importlib.metadata import version

__version__ = version("eomgen")
