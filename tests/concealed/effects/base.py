"""What an effect is here: a way to draw its parameters, and what it does to the touches of a scene.

Signs: `measured = true + d`; r = n . d > 0 when the surface seems too far out. A Change adds to the errors of
the carriages (then the exact kinematics finds the levers), to the tip, or to the reading along the normal.
Parameters that scale with the size of the effect are named, so that the generator can reach a wanted
signal-to-noise ratio; the others shape it.
"""

from dataclasses import dataclass, field
from typing import Callable

from portable import np


@dataclass
class Change:
    carriages: dict = field(default_factory=dict)  # axis -> (translations um, rotations urad), (N, 3) each
    tip: np.ndarray = 0.0  # um, (N, 3), machine frame
    along: np.ndarray = 0.0  # um, (N,), along the normal


@dataclass(frozen=True)
class Effect:
    name: str
    draw: Callable  # (scene, rng) -> parameters
    change: Callable  # (scene, parameters) -> Change
    scale: tuple  # parameters proportional to the size; the first one is judged by `largest`
    largest: float  # of the first, in its unit: the range that the literature gives
    factors: tuple  # where a diagnosis may rightly place it
    needs: tuple = ()  # columns of the recording without which it cannot be judged
    designs: str = "ACDE"
    known: bool = False  # hopeless on an unknown machine
    spans: int = 4  # draws whose combinations are the effect again; many where it is a sum of many free terms


CATALOGUE = {}


def effect(name, draw, change, scale, largest, factors, **more):
    CATALOGUE[name] = Effect(name, draw, change, tuple(scale), largest, tuple(factors), **more)


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def along_axis_or_oblique(rng):
    """Half of the directions are an axis of the machine, half are anything."""
    return np.eye(3)[rng.integers(3)] if rng.uniform() < 0.5 else unit(rng)


def vector(direction, factor):
    return np.outer(factor, direction)


def conduction_response(t, tau):
    """Mean temperature of a slab after a step of its surface temperature, 0 to 1: the series of the 1-D heat
    equation, not one exponential."""
    k = 2 * np.arange(40) + 1
    return 1 - np.sum(8 / (np.pi * k) ** 2 * np.exp(-np.outer(np.maximum(t, 0) / tau, k**2)), 1)


def slab_gradient(t, thickness=0.2, diffusivity=1.2e-6, conductivity=3.0, top=8.0, bottom=4.0):
    """Top minus bottom, as bending sees it, of a granite slab (m, m^2/s, W/mK, W/m^2K) after a step of 1 K of
    the air above at t = 0, s. Finite volumes through the thickness, exact in time. Bending takes the first
    moment: 12/h^2 int T (z - h/2) dz, which is the difference for a straight profile."""
    n = 40
    cell = thickness / n
    capacity = conductivity / diffusivity * cell
    flow = np.diag(np.full(n - 1, 1.0), 1) + np.diag(np.full(n - 1, 1.0), -1) - np.diag([1.0] + [2.0] * (n - 2) + [1.0])
    flow *= conductivity / cell
    flow[0, 0] -= bottom
    flow[-1, -1] -= top
    heat = np.zeros(n)
    heat[-1] = top
    steady = -np.linalg.solve(flow, heat)
    rates, modes = np.linalg.eigh(flow / capacity)
    z = (np.arange(n) + 0.5) / n - 0.5
    profile = steady[:, None] - modes @ (np.exp(np.outer(rates, np.maximum(t, 0))) * (modes.T @ steady)[:, None])
    return 12 * np.mean(profile * z[:, None], 0)
