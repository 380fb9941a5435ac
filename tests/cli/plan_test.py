"""What a recording could tell, from its plan alone: it is held against recordings that have just that."""
import json
import re

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"


class Plan(harness.Case):
    @classmethod
    def setUpClass(cls):
        cls.planned = None

    def diagnosis(self, *options):
        return json.loads(self.abbe("diagnose", *options, "--machine", MACHINE, "--format", "json").stdout)

    def record(self, *options):
        self.abbe("record", PROGRAM, "--machine", MACHINE, "-o", "rec.csv", *options)
        return self.folder / "rec.csv"

    def plan(self):
        if self.planned is None:
            type(self).planned = self.diagnosis(self.record(), "--design-only")
        return self.planned

    def row(self, effect):
        return next(d for d in self.plan()["smallest_detectable"] if d["effect"] == effect)

    def test_no_position_is_looked_at(self):
        """Rough ones were taken for those of a part with unknown surfaces, and nothing could be judged."""
        anywhere = self.changed(self.record(), lambda row: row | {"x": "0", "y": row["x"], "z": repr(float(row["z"]) + 0.5)}, "anywhere.csv")
        self.assertEqual(self.diagnosis(anywhere, "--design-only"), self.plan())
        read = self.changed(self.record(), lambda row: row | {f"enc_{a}": repr(float(row[f"enc_{a}"]) + 0.1 * float(row["n" + a])) for a in "xyz"}, "read.csv")
        self.assertEqual(self.diagnosis(read, "--design-only"), self.plan())

    def test_what_can_be_named_is_named(self):
        """Half as large again as what is told; the last one has richer rivals that could imitate it."""
        for effect in ("machine.backlash", "probe.pretravel_lobing", "probe.stylus_bending"):
            told = self.row(effect)
            said = self.diagnosis(self.record("--seed", 81, "--with", f"{effect}:{told['parameter']}={1.5 * told['name']:.6g}"))
            self.assertEqual([e["members"] for e in said["effects"]], [[effect]])

    def test_scatter_is_named_where_touches_are_repeated(self):
        """Of two runs; a single one cannot tell it from a pattern too fine for its touches."""
        def runs(*options):
            paths = []
            for run in (1, 2):
                self.abbe("record", PROGRAM, "--machine", MACHINE, "-o", f"{run}.csv", "--run", run, *options)
                paths.append(self.folder / f"{run}.csv")
            return paths

        twice = {d["effect"]: d for d in self.diagnosis(*runs(), "--design-only")["smallest_detectable"]}
        for effect in ("noise.vibration", "noise.unequal"):
            self.assertIsNone(self.row(effect)["name"])
            self.assertLess(twice[effect]["name"], self.row(effect)["detect"])
        for effect in ("noise.outliers", "noise.resolution"):
            self.assertEqual(twice[effect]["name"], twice[effect]["detect"])
        told = twice["noise.vibration"]["name"]
        for seed in (91, 92, 93):
            for share, named in ((1.5, [["noise.vibration"]]), (0.4, [])):
                shaken = f"noise.vibration:sd_um={share * told:.6g},direction=y"
                said = self.diagnosis(*runs("--seed", seed, "--with", shaken))
                self.assertEqual([e["members"] for e in said["effects"]], named)
                self.assertTrue(all(e["probability"] > 0.9 for e in said["effects"]))

    def test_a_size_is_told_with_its_form(self):
        """A rise of 0.6 K was promised to be named, and at the time constant that a user gives, of hours, never was."""
        told = self.row("thermal.ram_growth")
        self.assertEqual([*told["form"]], ["tau_s"])
        self.assertLess(told["form"]["tau_s"], 100)   # of 166 s in all
        size = f"thermal.ram_growth:{told['parameter']}={1.5 * told['name']:.6g}"
        said = self.diagnosis(self.record("--seed", 81, "--with", f"{size},tau_s={told['form']['tau_s']:.6g}"))
        self.assertIn("thermal.ram_growth", [m for e in said["effects"] for m in e["members"]])
        self.assertEqual(self.diagnosis(self.record("--seed", 81, "--with", f"{size},tau_s=5000"))["verdict"], "no_mismatch")
        self.assertEqual(self.row("machine.squareness")["form"], {"which": "awz"})
        self.assertEqual(self.row("noise.vibration")["form"], {"direction": "x"})   # every way half of it shows
        self.assertEqual(self.row("machine.step")["form"].keys(), {"t0_s", "along"})   # at_mm is of a step along an axis
        self.assertRegex(self.abbe("diagnose", self.folder / "rec.csv", "--machine", MACHINE, "--design-only").stdout, r"(?m)^thermal.ram_growth .* tau [0-9.]+ s ")

    def test_what_looks_alike_is_not(self):
        for effect, twin in (("probe.tip_radius", "probe.trigger_delay"), ("machine.step", "part.shift")):
            told = self.row(effect)
            self.assertIsNone(told["name"])
            self.assertIn(twin, told["confounded_with"])
        said = self.diagnosis(self.record("--with", "probe.tip_radius:amplitude_um=3"))
        self.assertGreater(len(said["effects"][0]["members"]), 1)

    def test_what_is_named_is_seen_before(self):
        for told in self.plan()["smallest_detectable"]:
            self.assertGreater(told["detect"], 0)
            if told["name"] is not None:
                self.assertLessEqual(told["detect"], told["name"])
                self.assertLessEqual(told["detect_um"], told["name_um"])

    def test_a_plan_of_few_touches_says_what_recordings_of_it_say(self):
        """One recording's noise and errors are a matter of chance, and the best of hundreds of explanations takes some of it away; told are those of
        the specification. Of one recording the size differs by 14 %, so that the mean of four lies within 15 % of the plan's in 97 of 100."""
        ball = harness.ROOT / "examples/iso10360/form_and_size_1x25.dmi"
        def size(*options):
            return next(d["detect"] for d in self.diagnosis("ball.csv", *options)["smallest_detectable"] if d["effect"] == "probe.tip_radius")

        recorded = []
        for seed in (501, 502, 504, 509):
            self.abbe("record", ball, "--machine", MACHINE, "--seed", seed, "-o", "ball.csv")
            recorded.append(size())
        for seed in (1, 2):
            self.assertAlmostEqual(size("--design-only", "--seed", seed) / (sum(recorded) / len(recorded)), 1, delta=0.15)

    def test_what_shows_only_at_an_impossible_size_is_no_promise(self):
        """25 touches on one ball would tell scallops of an error map by their name if they were of 25 um: none are."""
        ball = harness.ROOT / "examples/iso10360/form_and_size_1x25.dmi"
        self.abbe("record", ball, "--machine", MACHINE, "-o", "ball.csv")
        said = self.diagnosis("ball.csv", "--design-only")
        for d in said["smallest_detectable"]:
            limits = re.search(rf"(?m)^  {d['parameter']} .*; \S+ to (\S+)$", self.abbe("explain", d["effect"]).stdout)
            self.assertLessEqual(d["name"] or d["detect"], float(limits[1]), d["effect"])
        scallops, = (d for d in said["smallest_detectable"] if d["effect"] == "machine.map_scallops")
        self.assertIsNone(scallops["name"])

    def test_each_question_is_asked_once(self):
        asked = self.plan()["next_measurement"]
        self.assertGreaterEqual(len(asked), 2)
        first = [n["separates"][0] for n in asked]
        for k, n in enumerate(asked):
            self.assertEqual(set(n["separates"]) - set(self.row(first[k])["confounded_with"]), {first[k]})
            for before in asked[:k]:
                self.assertNotIn(first[k], before["separates"])
            self.assertGreater(n["expected_probability"], 1 / len(n["separates"]) + 0.05)
            self.assertEqual(bool(n["program"]), k == 0)
        # What shows most at its typical size comes into it, not what a machine has to be broken for.
        self.assertTrue({"probe.step", "head.reindexing", "thermal.ram_growth"} <= {e for n in asked for e in n["separates"]})
        self.assertFalse({"thermal.table_bending", "part.load_bending"} & {e for n in asked for e in n["separates"]})


if __name__ == "__main__":
    harness.main()
