"""`python -m diorama_app.cli`: the command line without the installed script."""

import sys

from diorama_app.cli import main

sys.exit(main())
