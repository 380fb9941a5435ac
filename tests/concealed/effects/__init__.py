"""The effects that can be concealed. CATALOGUE: those that the program under test knows by name; the unknown
ones are in modules of their own."""

from . import head, part, probe, structure, thermal  # noqa: F401  they register themselves
from . import unknown_eighteenth, unknown_eighth, unknown_eleventh  # noqa: F401  these too
from . import unknown_fifteenth, unknown_fourteenth, unknown_later  # noqa: F401
from . import unknown_nineteenth, unknown_ninth  # noqa: F401
from . import unknown_seventeenth, unknown_seventh, unknown_sixteenth, unknown_tenth  # noqa: F401
from . import unknown_thirteenth, unknown_twelfth, unknown_twentieth, unknown_twentyfirst  # noqa: F401
from . import unknown_twentyfourth, unknown_twentysecond, unknown_twentythird  # noqa: F401
from .base import CATALOGUE, Change, Effect  # noqa: F401
