"""The effects that can be concealed. CATALOGUE: those that the program under test knows by name; the unknown
ones are in modules of their own."""

from . import head, part, probe, structure, thermal, unknown_later, unknown_latest  # noqa: F401  they register themselves
from .base import CATALOGUE, Change, Effect  # noqa: F401
