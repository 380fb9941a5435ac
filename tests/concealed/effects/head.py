"""Effects of the articulating head, with finite rotations: B turns about the axis of the mount and carries A.
um, urad."""

from portable import np

import machine as cmm
from .base import Change, effect


def draw_axes(scene, rng):
    return {"translation_um": 1.0, "rotation_urad": rng.uniform(3, 15), "motion": rng.normal(size=(2, 6, 4))}


def axis_motion(q, k):
    """Six error motions of a rotary axis as low harmonics that vanish at q = 0."""
    basis = np.stack([np.cos(q) - 1, np.sin(q), (np.cos(2 * q) - 1) / 2, np.sin(2 * q) / 2])
    return (np.asarray(k) @ basis).T


def change_axes(scene, p):
    """Link by link: tip -> error of A -> turn by A -> error of B -> turn by B."""
    of_a, of_b = axis_motion(scene.a, p["motion"][0]), axis_motion(scene.b, p["motion"][1])
    zero = np.zeros_like(scene.a)
    turn_a, turn_b = cmm.head_rotation(scene.a, zero), cmm.head_rotation(zero, scene.b)
    tip = np.einsum("nij,nj->ni", turn_a, scene.tip_in_r)
    tip = cmm.rotate(of_a[:, 3:] * p["rotation_urad"] * 1e-6, tip) + of_a[:, :3] * p["translation_um"] * 1e-3
    tip = np.einsum("nij,nj->ni", turn_b, tip)
    tip = cmm.rotate(of_b[:, 3:] * p["rotation_urad"] * 1e-6, tip) + of_b[:, :3] * p["translation_um"] * 1e-3
    return Change(tip=(tip - scene.arm) * 1e3)


def draw_sag(scene, rng):
    return {
        "bending_um": rng.uniform(0.3, 1),
        "joint_um": rng.uniform(0.1, 1),
        "at_length_mm": float(max(s.length for s in scene.styli)),
    }


def change_sag(scene, p):
    """A lying bar with a mass at its end, on an elastic joint; the true tip hangs low, the machine reads
    high."""
    ratio = scene.length / p["at_length_mm"]
    up = np.array([0, 0, 1.0]) - scene.shank * scene.shank[:, 2:3]
    return Change(tip=up * (p["bending_um"] * ratio**3 + p["joint_um"] * ratio**2)[:, None])


def draw_qualification(scene, rng):
    return {
        "growth_um_per_K": rng.uniform(0.2, 1) * rng.choice([-1, 1]),
        "tilt_a_urad_per_K": rng.normal(0, 4),
        "tilt_b_urad_per_K": rng.normal(0, 4),
        "qualified_at_C": 20.0,
    }


def change_qualification(scene, p):
    warmer = scene.temperature["air"] - p["qualified_at_C"]
    a, b = scene.a + p["tilt_a_urad_per_K"] * warmer * 1e-6, scene.b + p["tilt_b_urad_per_K"] * warmer * 1e-6
    turned = np.einsum("nij,nj->ni", cmm.head_rotation(a, b), scene.tip_in_r)
    return Change(tip=(turned - scene.arm) * 1e3 + scene.shank * (p["growth_um_per_K"] * warmer)[:, None])


HEAD = ("head_A_deg", "head_B_deg", "sensor")
effect(
    "head.axis_errors",
    draw_axes,
    change_axes,
    ["translation_um", "rotation_urad"],
    20,
    ["head", "sensor"],
    needs=HEAD,
    designs="CD",
    spans=48,
)
effect("head.sag", draw_sag, change_sag, ["bending_um", "joint_um"], 5, ["head", "sensor"], needs=HEAD, designs="CD")
effect(
    "head.qualification",
    draw_qualification,
    change_qualification,
    ["growth_um_per_K", "tilt_a_urad_per_K", "tilt_b_urad_per_K"],
    2,
    ["temperature", "head", "sensor", "time"],
    needs=("temp_air_C",),
    designs="D",
)
