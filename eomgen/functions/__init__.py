"""Functions that a program has when it is asked for them, each sliced to what it needs."""
