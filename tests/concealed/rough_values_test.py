#!/usr/bin/env python3
"""Lengths that rough machines in order report. usage: rough_values_test.py PATH-OF-ABBE

The error functions of a real machine are not the harmonics of the simulated ones: here they are a straight line and a
spline through random numbers 50 to 150 mm apart. The machines satisfy the MPE, so their recordings of values are no
mismatch. Skipped (77) without numpy.
"""

import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    from portable import np
except ModuleNotFoundError:
    print("needs numpy (Debian: python3-numpy)")
    sys.exit(77)

import machine as cmm
import seal

ABBE = pathlib.Path(sys.argv.pop()).resolve()
MACHINE = dataclasses.replace(cmm.MACHINES[0], name="coord3-mc16", head_length=0)
TIP = np.array([0.0, 0.0, -300.0])
STEPS = 8
LOW, HIGH = np.array([100.0, 100, -100]), np.array([1500.0, 900, -700])


def lines():
    """Of a step gauge, along the axes and the diagonals of the volume: scale readings of its faces, and its direction."""
    ends = {}
    for k, axis in enumerate(cmm.AXES):
        ends[axis] = np.where(np.arange(3) == k, LOW, (LOW + HIGH) / 2)
    for k, corner in enumerate(((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0))):
        ends[f"d{k + 1}"] = np.where(corner, HIGH, LOW)
    for name, start in ends.items():
        way = LOW + HIGH - 2 * start
        yield name, start + np.linspace(0, 1, STEPS + 1)[:, None] * way, way / np.linalg.norm(way)


def program():
    text = "DMISMN/'step gauge',4.0\nUNITS/MM,ANGDEC\nPRCOMP/ON\n"
    text += "S(DOWN)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,300,4\nSNSLCT/S(DOWN)\n"
    for name, readings, way in lines():
        for k, point in enumerate(readings + TIP):
            face = ",".join(f"{v:.9f}" for v in (*point, *-way))
            text += f"F({name}_{k})=FEAT/POINT,CART,{face}\nMEAS/POINT,F({name}_{k}),1\nPTMEAS/CART,{face}\nENDMES\n"
            if k > 0:
                length = np.linalg.norm(readings[k] - readings[0])
                text += f"T(L_{name}_{k})=TOL/DISTB,NOMINL,{length:.9f},-0.02,0.02,PT2PT\n"
                text += f"OUTPUT/FA({name}_0),FA({name}_{k}),TA(L_{name}_{k})\n"
    return text + "ENDFIL\n"


def rough_geometry(rng):
    out = cmm.Geometry()
    for axis in MACHINE.chain:
        row = []
        for motion in range(6):
            count = max(4, round(MACHINE.travel[axis] / rng.uniform(50, 150)) + 1)
            knots, line = np.linspace(-1, 1, count), cmm.SHARES[cmm.share_of(axis, motion)][0]
            rough = rng.normal(size=count)
            y = line * knots * rng.choice([-1, 1]) + (1 - line) * rough / np.abs(rough).max()
            y -= y[0]
            y *= cmm.size_of(MACHINE, axis, motion) * rng.uniform(-1, 1) / np.abs(y).max()
            row.append(cmm.natural_spline(knots, y))
        out.functions[axis] = row
    return out


def machine_in_order(rng):
    """The errors of a machine along each line, um: the worst length takes half of its MPE or more, and no more than it."""
    while True:
        geometry, errors, worst = rough_geometry(rng), {}, 0
        for name, readings, way in lines():
            tip = np.tile(TIP, (len(readings), 1))
            e = errors[name] = cmm.tip_error(MACHINE, readings, tip, geometry.carriages(MACHINE, readings)) @ way
            length = np.linalg.norm(readings[1:] - readings[0], axis=1)
            worst = max(worst, np.max(np.abs(e[1:] - e[0]) / (MACHINE.mpe[0] + MACHINE.mpe[1] * 1e-3 * length)))
        if 0.5 <= worst <= 1:
            return errors


def recording(seed, scale_um_per_m=0.0):
    rng = seal.generator("rough values", seed)
    errors, rows = machine_in_order(rng), ["# machine: coord3-mc16", "characteristic,value"]
    for name, readings, way in lines():
        d = errors[name] + scale_um_per_m * 1e-3 * (readings @ way) + rng.normal(size=len(readings)) * MACHINE.probe_sd
        for k in range(1, STEPS + 1):
            length = np.linalg.norm(readings[k] - readings[0]) + (d[k] - d[0]) * 1e-3
            rows.append(f"L_{name}_{k},{length:.6f}")
    return "\n".join(rows) + "\n"


class RoughValues(unittest.TestCase):
    def alarms(self, seeds, **effect):
        count = 0
        with tempfile.TemporaryDirectory() as folder:
            plan, values = pathlib.Path(folder, "step_gauge.dmi"), pathlib.Path(folder, "values.csv")
            plan.write_text(program())
            for seed in seeds:
                values.write_text(recording(seed, **effect))
                words = [ABBE, "diagnose", values, "--program", plan, "--format", "json"]
                said = json.loads(subprocess.run(words, capture_output=True, check=True, text=True).stdout)
                count += said["p_value"] <= 0.01
        return count

    def test_rough_machines_in_order_are_seldom_a_mismatch(self):
        """By machines of the specification alone 63 of 102 were one; beside rougher ones 2 of the first 43 are: knots 50 mm apart
        are finer than either."""
        # Of 8 that alarm in 7 of 100, 4 or more do in 0.1 % of such tests; so many did.
        self.assertLess(self.alarms(range(8)), 4)

    def test_an_error_of_the_scales_is_found_on_them(self):
        self.assertGreaterEqual(self.alarms(range(100, 103), scale_um_per_m=40), 2)


if __name__ == "__main__":
    unittest.main()
