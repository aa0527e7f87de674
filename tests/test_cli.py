"""The command line as its user meets it: what it writes, says, refuses, and its exit codes."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from commandline import eomgen
from scenes import SHIPPED
from studies import PENDULUM

from eomgen import __version__, files, shelf
from eomgen.cli import commands
