"""Programs run as a user runs them: our own command line, compilers, typesetters."""

import os
import subprocess
import sys

TIMEOUT = 240  # seconds; a program that hangs is a failure, not a stuck suite


def start(*words, folder=None, standard_input=None, **environment):
    """A running program; its output and errors are text in UTF-8."""
    return subprocess.Popen(
        [str(word) for word in words],
        cwd=folder,
        stdin=standard_input or subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        env={**os.environ, **environment},
    )


def finish(process, text=None):
    """What a program said; it must have succeeded."""
    try:
        said, complained = process.communicate(text, timeout=TIMEOUT)
    finally:
        process.kill()
    assert process.returncode == 0, f"{process.args}\n{said}\n{complained}"
    return said


def run(*words, text=None, **more):
    """Start and finish a program; `text` is its standard input."""
    pipe = {} if text is None else {"standard_input": subprocess.PIPE}
    return finish(start(*words, **pipe, **more), text)


def together(commands, **more):
    """Run programs side by side; what each said, in order."""
    running = [start(*words, **more) for words in commands]
    try:
        return [finish(process) for process in running]
    finally:
        for process in running:  # where one failed, the others are neither left running nor open
            process.kill()
            process.communicate()


def eomgen(*words):
    """The words of a call of our command line."""
    return (sys.executable, "-m", "eomgen.cli", *words)
