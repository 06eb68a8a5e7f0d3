"""`python -m touchdown`: the command."""

import sys

from touchdown.command.cli import main

sys.exit(main())
