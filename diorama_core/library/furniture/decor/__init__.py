"""What is there to be looked at."""

from __future__ import annotations

from diorama_core.library.furniture.decor import boards, clocks, globes, mirrors, pictures, sculptures, vases
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(vases, pictures, mirrors, clocks, boards, sculptures, globes)
