"""Pictures of planes with few texels, as tests make them, in processes that import this: a build then takes half the
time. The command line with them: `python -m tests.small_planes build …`.
"""

import sys

from diorama_core.architecture.texture import plane_textures

plane_textures.MAX_SIDE_PX //= 4
plane_textures.MAX_CEILING_PX //= 4

if __name__ == "__main__":
    from diorama_app.cli import main

    sys.exit(main())
