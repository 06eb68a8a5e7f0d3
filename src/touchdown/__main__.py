"""`python -m touchdown`: the command."""

import sys

from touchdown.master.cli import main

sys.exit(main())
