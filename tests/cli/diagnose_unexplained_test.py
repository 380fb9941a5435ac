"""abbe diagnose of physics that the catalogue does not have: the pattern is saved as an empirical effect, and that machine explains more."""
import csv
import io
import itertools
import json
import math

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"


class Unexplained(harness.Case):
    def recorded(self, name, dent):
        """A recording of a sphere that is larger by dent(normal, share of the touches before) mm, which no effect makes."""
        self.abbe("record", self.sphere(), "--machine", MACHINE, "-o", "clean.csv", "--seed", 4)
        lines = (self.folder / "clean.csv").read_text().splitlines()
        comments = [line for line in lines if line.startswith("#")]
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        for number, row in enumerate(rows):
            n = [float(row["n" + a]) for a in "xyz"]
            for k, a in enumerate("xyz"):
                row[a] = repr(float(row[a]) + dent(n, number / len(rows)) * n[k])
        out = io.StringIO()
        writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return self.write(name, "\n".join(comments) + "\n" + out.getvalue())

    def lobed(self, spheres, amplitude):
        """Lobes of the pretravel on some of the five spheres: a probe that is not the same all the time."""
        self.abbe("record", PROGRAM, "--machine", MACHINE, "-o", "with.csv", "--seed", 4, "--with", f"probe.pretravel_lobing:amplitude_um={amplitude}")
        self.abbe("record", PROGRAM, "--machine", MACHINE, "-o", "clean.csv", "--seed", 4)
        rows = [(self.folder / name).read_text().splitlines() for name in ("with.csv", "clean.csv")]
        lines = [a if a.split("_")[0] in spheres else b for a, b in zip(*[[r for r in lines if not r.startswith("# effects")] for lines in rows])]
        return self.write("lobed.csv", "\n".join(lines) + "\n")

    def diagnosis(self, *args):
        return json.loads(self.abbe("diagnose", *args, "--format", "json").stdout)

    def box(self, seed=2):
        """Nine touches on each of five faces of a box, with a scale that reads long: that is one face that is elsewhere."""
        faces = [("TOP", (200, 150, 0), (0, 0, 1)), ("FRONT", (200, 0, -60), (0, -1, 0)), ("RIGHT", (400, 150, -60), (1, 0, 0)),
                 ("BACK", (200, 300, -60), (0, 1, 0)), ("LEFT", (0, 150, -60), (-1, 0, 0))]
        text = harness.LENGTH.split("S(P)=")[0] + ("S(P)=SNSDEF/PROBE,INDEX,POL,0.0,0.0,0.0,0.0,-1.0,150.0,4.0\nSNSLCT/S(P)\n"
                                                   "D(M)=DATSET/MCS\nD(R)=TRANS/XORIG,500,YORIG,300,ZORIG,-450\n")
        for label, at, n in faces:
            points = [(x, y, z) for x in ({at[0]} if n[0] else (30, 200, 370)) for y in ({at[1]} if n[1] else (30, 150, 270))
                      for z in ({at[2]} if n[2] else (-20, -60, -100))]
            above = [f"GOTO/{x + 40 * n[0]},{y + 40 * n[1]},60\nGOTO/{x + 40 * n[0]},{y + 40 * n[1]},{z + 20 * n[2]}\n"
                     f"PTMEAS/CART,{x},{y},{z},{n[0]},{n[1]},{n[2]}\nGOTO/{x + 40 * n[0]},{y + 40 * n[1]},60\n" for x, y, z in points]
            text += f"F({label})=FEAT/PLANE,CART,{at[0]},{at[1]},{at[2]},{n[0]},{n[1]},{n[2]}\nMEAS/PLANE,F({label}),9\n" + "".join(above) + "ENDMES\n"
        self.abbe("record", self.write("box.dmi", text + "ENDFIL\n"), "--seed", seed, "--with", "machine.scale:scale_um_per_m=60,axis=x", "-o", "box.csv")
        return self.folder / "box.csv"

    def test_an_effect_that_is_there_is_of_one_size(self):
        """What acts on three of five spheres is no such effect, though it looks like it; what acts on all is."""
        there = self.diagnosis(self.lobed(("P1", "P2", "P3", "P4", "P5"), 0.15), "--machine", MACHINE)
        self.assertEqual(there["effects"][0]["members"], ["probe.pretravel_lobing"])
        self.assertGreater(there["effects"][0]["probability"], 0.9)
        self.assertNotIn("differs", there["effects"][0]["sentence"])
        partly = self.diagnosis(self.lobed(("P1", "P2", "P3"), 0.15), "--machine", MACHINE, "--model-out", "m.json")
        self.assertEqual(partly["verdict"], "unexplained")
        self.assertEqual(partly["effects"], [])
        self.assertEqual(partly["unexplained"]["shape"], "probe.pretravel_lobing, not of one size")
        self.assertRegex(partly["unexplained"]["sentence"], r"probe.pretravel_lobing comes nearest, but its size differs: 1\.\d ± 0\.\d times that of all touches")

    def test_what_explains_it_as_well_is_told(self):
        said = self.diagnosis(self.box(seed=4))
        self.assertEqual(said["verdict"], "one_of")
        self.assertIn("machine.scale", said["effects"][0]["members"])
        self.assertIn("A pattern over", said["effects"][0]["sentence"])
        self.assertIn("would explain it as well", said["effects"][0]["sentence"])

    def test_a_mirror_says_nothing_against_a_name(self):
        """A face that is twisted by a micrometre, which no effect does to it alone. The name leaves that, but so does the face that is elsewhere."""
        twist = {0: 1, 2: -1, 6: -1, 8: 1}  # by touch of the upper face

        def twisted(row):
            row["z"] = repr(float(row["z"]) + 1.1e-3 * twist.get(next(number), 0))
            return row

        number = itertools.count()
        said = self.diagnosis(self.changed(self.box(), twisted))
        self.assertLess(said["adequacy_p_value"], 0.05)
        self.assertIn("machine.scale", said["effects"][0]["members"])
        self.assertEqual(said["effects"][0]["probability"], 0.5)

    def test_two_effects_are_named_though_neither_is_the_likeliest(self):
        """A larger tip with lobes looks most like a tip that is not round, and more like a pattern."""
        self.abbe("record", self.sphere(), "--machine", MACHINE, "--seed", 1, "-o", "pair.csv",
                  "--with", "probe.tip_radius:amplitude_um=2", "--with", "probe.pretravel_lobing:amplitude_um=0.15")
        said = self.diagnosis("pair.csv", "--machine", MACHINE)
        members = [e["members"] for e in said["effects"]]
        self.assertEqual(len(members), 2, members)
        self.assertTrue(any("probe.tip_radius" in m for m in members), members)
        self.assertIn(["probe.pretravel_lobing"], members)

    def test_lobes_of_a_part_are_no_period_of_a_scale(self):
        """Five lobes about the vertical axis of the ball: the catalogue's form ends at three."""
        recording = self.recorded("lobed.csv", lambda n, _: 0.003 * math.sin(5 * math.atan2(n[1], n[0])) * (1 - n[2] ** 2))
        said = self.diagnosis(recording, "--machine", MACHINE)
        self.assertEqual(said["verdict"], "unexplained")
        self.assertEqual((said["unexplained"]["factor"], said["unexplained"]["shape"]), ("feature", "lobes"))

    def test_the_pattern_is_saved_and_explains(self):
        recording = self.recorded("dented.csv", lambda n, _: 0.012 * math.exp(-((n[0] - 0.5) ** 2 + (n[1] - 0.6) ** 2 + (n[2] - 0.62) ** 2) / 0.25))
        before = self.diagnosis(recording, "--machine", MACHINE, "--model-out", "improved.json")
        self.assertEqual(before["verdict"], "unexplained")
        # Some of the 11 um that a touch is off passes for another place or size of the sphere.
        self.assertGreater(before["unexplained"]["largest_um"], 3 * before["unexplained"]["amplitude_um"]["value"])
        self.assertLess(before["unexplained"]["largest_um"], 12)
        self.assertRegex(before["unexplained"]["sentence"], r"of [\d.]+ um rms, at most [\d.]+ um at a touch, is in the recording")
        model = before["unexplained"]["model"]
        self.assertIn(model, ("empirical.curve", "empirical.direction"))
        effects = [e["name"] for e in json.loads((self.folder / "improved.json").read_text())["effects"]]
        self.assertIn(model, effects)
        after = self.diagnosis(recording, "--machine", "improved.json")
        left = after["unexplained"]["amplitude_um"]["value"] if after["unexplained"] else 0
        self.assertLess(left, 0.7 * before["unexplained"]["amplitude_um"]["value"])
        size = lambda machine: next(c for c in self.run_json(self.sphere(), "--machine", machine, "--machines", 100)["characteristics"] if c["tolerance"] == "FORM")
        self.assertGreater(size("improved.json")["mean"], size(MACHINE)["mean"] + 0.001)

    def test_a_pattern_that_no_program_shares_is_saved_as_one_that_it_does(self):
        # The part is larger in x and smaller in y from half of the time on: direction in time.
        recording = self.recorded("grown.csv", lambda n, share: math.copysign(0.012, share - 0.5) * (n[0] ** 2 - n[1] ** 2))
        said = self.diagnosis(recording, "--machine", MACHINE, "--model-out", "improved.json")
        self.assertEqual(said["verdict"], "unexplained", said["effects"])
        self.assertEqual(said["unexplained"]["shape"], "in time", "on a ball, place and direction are one")
        saved = [e["name"] for e in json.loads((self.folder / "improved.json").read_text()).get("effects", [])]
        if said["unexplained"]["model"]:
            self.assertIn(said["unexplained"]["model"], saved)
        else:
            self.assertEqual([name for name in saved if name.startswith("empirical.")], [])

    def test_empirical_effects_move_what_they_say(self):
        def touches(*options):
            self.abbe("record", self.sphere(), "--machine", MACHINE, "-o", "rec.csv", *options)
            lines = [line for line in (self.folder / "rec.csv").read_text().splitlines() if not line.startswith("#")]
            return list(csv.DictReader(lines))
        clean = touches()

        def moved(*options):
            """n . d in um of every touch."""
            return [1000 * sum(float(a["n" + k]) * (float(a[k]) - float(b[k])) for k in "xyz") for a, b in zip(touches(*options), clean)]
        for got, row in zip(moved("--with", "empirical.offset:of=sensor,sensor=1,z_um=5,r_um=2"), clean):
            self.assertAlmostEqual(got, 5 * float(row["nz"]) + 2, delta=0.01)
        for got, row in zip(moved("--with", "empirical.offset:of=orientation,head_A_deg=0,head_B_deg=0,x_um=3"), clean):
            self.assertAlmostEqual(got, 3 * float(row["nx"]) if float(row["head_A_deg"]) == 0 else 0, delta=0.01)
        for got, row in zip(moved("--with", "empirical.direction:frame=machine,xxyz_um=4"), clean):
            self.assertAlmostEqual(got, 4 * float(row["nx"]) ** 2 * float(row["ny"]) * float(row["nz"]), delta=0.01)
        for got, row in zip(moved("--with", "empirical.curve:along=time,from=0,to=150,y0_um=6,y1_um=6"), clean):
            share = max(0.0, min(1.0, 2 - float(row["time_s"]) / 10))
            self.assertAlmostEqual(got, 6 * share * float(row["ny"]), delta=0.01)
        for got in moved("--with", "empirical.curve:along=speed,from=0,to=1," + ",".join(f"r{k}_um=2" for k in range(16))):
            self.assertAlmostEqual(got, 2, delta=0.01)
        radius = float((self.folder / "rec.csv").read_text().split("diameter_mm ")[1].split()[0]) / 2
        x, y = ([float(row["t" + a]) - radius * float(row["n" + a]) for row in clean] for a in "xy")  # of the surface
        at = f"plane=xy,from_1={min(x)},to_1={max(x)},from_2={min(y)},to_2={max(y)}"
        map_of_both = moved("--with", f"empirical.map:{at}," + ",".join(f"z_5_{k}_um=6" for k in range(6)) + ",r_0_0_um=3")
        for got, row, px, py in zip(map_of_both, clean, x, y):
            s, t = 5 * (px - min(x)) / (max(x) - min(x)), 5 * (py - min(y)) / (max(y) - min(y))
            self.assertAlmostEqual(got, 6 * max(0, s - 4) * float(row["nz"]) + 3 * max(0, 1 - s) * max(0, 1 - t), delta=0.02)


if __name__ == "__main__":
    harness.main()
