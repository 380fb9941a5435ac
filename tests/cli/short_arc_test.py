"""abbe run and abbe fit on arcs so short that the radius is known poorly, but known."""
import json
import math

import harness

RADIUS, TOUCHES = 1000.0, 7


def angles(degrees):
    return [math.radians(degrees) * (t / (TOUCHES - 1) - 0.5) for t in range(TOUCHES)]


def program(degrees):
    touches = "".join(f"PTMEAS/CART,{RADIUS * math.sin(a):.9f},{RADIUS * math.cos(a):.9f},0,{math.sin(a):.9f},{math.cos(a):.9f},0\n"
                      for a in angles(degrees))
    return f"""DMISMN/'a short arc',4.0
UNITS/MM,ANGDEC
PRCOMP/ON
SNSLCT/SA(A0B0)
D(A)=TRANS/XORIG,800,YORIG,-600,ZORIG,-600
F(C)=FEAT/CIRCLE,OUTER,CART,0,0,0,0,0,1,{2 * RADIUS}
T(D)=TOL/DIAM,-5,5
MEAS/CIRCLE,F(C),{TOUCHES}
{touches}ENDMES
OUTPUT/FA(C),TA(D)
ENDFIL
"""


def linearised_u(degrees, noise_mm):
    """Standard uncertainty of the diameter: the radius is the coefficient of 1 - cos a, beside one of sin a and one of cos a, of
    which over a short arc the mean and the slope are left."""
    heights = [1 - math.cos(a) for a in angles(degrees)]
    mean = sum(heights) / TOUCHES
    return 2 * noise_mm / math.sqrt(sum((h - mean) ** 2 for h in heights))


class ShortArcs(harness.Case):
    def figures(self, *options):
        report = json.loads(self.abbe("run", "arc.dmi", "--machines", 400, "--format", "json", *options).stdout)
        return report["characteristics"][0], report["traps"]

    def test_every_machine_has_its_circle_and_u_is_that_of_the_linearised_model(self):
        machine = json.loads((harness.ROOT / "examples/machines/coord3-mc16.json").read_text())
        noise_mm = machine["probe"]["sd_um"][0] / 1000
        for degrees in (0.6, 1.0, 2.0):
            with self.subTest(degrees=degrees):
                self.write("arc.dmi", program(degrees))
                diameter, traps = self.figures("--threads", 1)
                self.assertEqual((diameter["evaluated"], diameter["trapped"], traps), (400, 0, []))
                self.assertAlmostEqual(diameter["reference"], 2 * RADIUS, delta=1e-3)  # the program has nine decimals
                self.assertAlmostEqual(diameter["u"] / linearised_u(degrees, noise_mm), 1, delta=0.12)  # 3.5 % are chance
                self.assertEqual(self.figures("--threads", 2), (diameter, traps))

    def test_an_arc_without_errors_is_fitted_from_the_points_alone(self):
        points = "".join(f"{RADIUS * math.sin(a)!r},{RADIUS * math.cos(a)!r},0\n" for a in angles(1))
        self.write("points.csv", "x,y,z\n" + points)
        circle = json.loads(self.abbe("fit", "circle", "points.csv", "--format", "json").stdout)
        self.assertAlmostEqual(circle["radius"], RADIUS, delta=1e-7)

    def test_a_straight_tube_is_no_torus(self):
        points = "".join(f"{20 * math.cos(2.4 * i)!r},{20 * math.sin(2.4 * i)!r},{0.7 * i!r}\n" for i in range(60))
        self.write("points.csv", "x,y,z\n" + points)
        self.assertIn("not_converged", self.refused("E0505", "fit", "torus", "points.csv"))


if __name__ == "__main__":
    harness.main()
