"""Adapters of public datasets, read from a local folder into this project's types; nothing is downloaded."""

from diorama_core.evaluation.adapters.front3d import read_front3d
from diorama_core.evaluation.adapters.scan2cad import read_scan2cad
from diorama_core.evaluation.adapters.ssdb import read_ssdb
from diorama_core.evaluation.adapters.sunrgbd import read_sunrgbd

__all__ = ["read_front3d", "read_scan2cad", "read_ssdb", "read_sunrgbd"]
