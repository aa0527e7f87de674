"""How exact the shipped code is: in float and double against fifty digits at many states."""
