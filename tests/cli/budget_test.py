"""abbe run --budget: which source and which touches the variance comes from."""
import json

import harness
from harness import LENGTH

# The x coordinate of the second point, counted from the first: half the variance of the probe is the alignment's.
ALIGNED = LENGTH.replace("F(B)=FEAT", "D(N)=TRANS/XORIG,FA(A)\nF(B)=FEAT").replace("T(LEN)=TOL/DISTB,NOMINL,100.0,-0.01,0.01,PT2PT",
                                                                               "T(X)=TOL/CORTOL,XAXIS,-0.01,0.01")
ALIGNED = ALIGNED.replace("OUTPUT/FA(A),FA(B),TA(LEN)", "OUTPUT/FA(B),TA(X)")


def machine(e_max=None, probe_um=0, **more):
    """A machine with the given error functions and probe, otherwise without errors, accepted whatever it measures."""
    file = json.loads((harness.ROOT / "examples/machines/coord3-mc16.json").read_text())
    comparator = json.loads((harness.ROOT / "examples/gauge_block_h1/comparator.json").read_text())
    components = comparator["geometry"]["components"]
    for name, size in (e_max or {}).items():
        components[name] = {"e_max": size}
    return json.dumps(file | {"name": "simple", "geometry": {"components": components}, "specification": comparator["specification"],
                              "probe": {"sd_um": [probe_um] * 3}} | more)


def shares(lines):
    return {line["name"]: line["share"] for line in lines}


class Budget(harness.Case):
    def budget(self, program, *options):
        self.write("p.dmi", program)
        (found,) = self.run_json("p.dmi", "--budget", *options)["characteristics"]
        return found

    def test_sources_sum_to_one_and_contributions_stay(self):
        found = self.budget(LENGTH, "--machines", 300)
        lines = shares(found["budget"])
        self.assertEqual(len(lines), 18 + 2)
        self.assertAlmostEqual(sum(lines.values()), 1, delta=1e-12)
        self.assertEqual(lines["head"], 0)    # one orientation
        self.assertEqual(set(found["contributions"]), {"geometry", "head", "probe"})
        plain = self.run_json("p.dmi", "--machines", 300)["characteristics"][0]
        self.assertEqual(plain["contributions"], found["contributions"])
        self.assertEqual(plain["u"], found["u"])
        self.assertNotIn("budget", plain)
        self.assertNotIn("alignment_split", plain)

    def test_a_program_without_alignment(self):
        split = shares(self.budget(LENGTH, "--machines", 100)["alignment_split"])
        self.assertEqual(split["alignment"], 0)
        self.assertAlmostEqual(split["feature"], 1, delta=1e-9)

    def test_only_one_error_function(self):
        self.write("exx.json", machine({"exx": 5}))
        found = self.budget(LENGTH, "--machine", "exx.json", "--machines", 100)
        self.assertGreater(found["u"], 1e-5)
        lines = {line["name"]: line for line in found["budget"]}
        self.assertEqual(lines["exx"]["share"], 1)
        self.assertAlmostEqual(lines["exx"]["u"], found["u"], delta=1e-12)
        self.assertEqual([line["name"] for line in found["budget"] if line["share"] != 0], ["exx"])

    def test_alignment_against_feature(self):
        self.write("probe.json", machine(probe_um=1))
        found = self.budget(ALIGNED, "--machine", "probe.json", "--machines", 2000)
        self.assertEqual(shares(found["budget"])["probe"], 1)
        split = shares(found["alignment_split"])
        self.assertEqual(set(split), {"alignment", "feature"})
        # Two equal variances: a share of 2000 machines has a standard error of about 1.6 %.
        self.assertLess(abs(split["alignment"] - 0.5), 0.08)
        self.assertAlmostEqual(sum(split.values()), 1, delta=1e-6)

    def test_effects_and_the_part_have_lines(self):
        self.write("tip.json", machine({"exx": 5}, effects=[{"name": "probe.tip_radius", "parameters": {"amplitude_um": {"value": 0, "u": 1}}}]))
        self.write("part.json", json.dumps({"schema": "abbe.workpiece/1", "name": "part", "surfaces": {"B": {"offset_um": {"value": 0, "u": 1}}}}))
        lines = shares(self.budget(LENGTH, "--machine", "tip.json", "--workpiece", "part.json", "--machines", 200)["budget"])
        self.assertEqual(len(lines), 18 + 4)
        self.assertAlmostEqual(sum(lines.values()), 1, delta=1e-12)
        self.assertGreater(lines["probe.tip_radius"], lines["part"])   # both ends against one
        self.assertGreater(lines["part"], 0)

    def test_text_has_a_second_table(self):
        self.write("exx.json", machine({"exx": 5}))
        self.write("p.dmi", LENGTH)
        text = self.abbe("run", "p.dmi", "--machine", "exx.json", "--machines", 50, "--budget").stdout
        self.assertRegex(text, r"\n +16  A, B +LEN +exx +0\.\d+ mm +100\.0 %\n")
        self.assertRegex(text, r"\n +16  A, B +LEN +feature +0\.\d+ mm +100\.0 %\n")
        self.assertNotIn("eyx", text)
        self.assertNotIn("source", self.abbe("run", "p.dmi", "--machine", "exx.json", "--machines", 50).stdout)


harness.main()
