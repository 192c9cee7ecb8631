from diorama_core.synthesis.text_to_home import *  # noqa
