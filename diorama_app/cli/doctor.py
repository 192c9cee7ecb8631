"""`diorama doctor`: can this machine run Diorama?"""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from diorama_app.cli.arguments import command


def add_doctor(commands: Any) -> None:
    """Declare `diorama doctor`."""
    p = command(commands, "doctor", _doctor, "Check that this machine can run Diorama.", "diorama doctor")
    p.add_argument("--json", action="store_true", help="print the findings as JSON")


def _doctor(a: argparse.Namespace) -> int:
    from diorama_app.cli.machine import examine

    findings = examine()
    if a.json:
        print(json.dumps([finding.__dict__ for finding in findings]))
    else:
        for finding in findings:
            mark = "ok  " if finding.ok else "FAIL" if finding.needed else "none"
            print(f"{mark}  {finding.name:<22} {finding.detail}")
    broken = [finding.name for finding in findings if finding.needed and not finding.ok]
    if broken:
        print(f"diorama: this machine lacks {', '.join(broken)}; see the lines above", file=sys.stderr)
    return 1 if broken else 0
