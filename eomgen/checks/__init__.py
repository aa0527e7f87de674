"""How the tool knows that what it prints is true: used by the command line and by the tests."""
